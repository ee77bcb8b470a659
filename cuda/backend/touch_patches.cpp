#include "cuda/backend/touch_patches.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <map>

namespace frontalis
{
namespace cuda
{
namespace
{

// Distance, in voxel edges, at which a corner of a triangle is still near a vertex. All triangles around the vertex are
// near it, so that a foot can cross an edge or pass a vertex within a plan. Larger values make patches compute more
// pairs.
constexpr double near_vertex = 0.75;

std::vector<std::uint32_t> counted(const std::vector<std::uint32_t>& voxel_of_vertex, std::size_t voxels)
{
  std::vector<std::uint32_t> first(voxels + 1, 0);
  for (const auto e : voxel_of_vertex)
    ++first[e + 1];
  for (std::size_t e = 0; e < voxels; ++e)
    first[e + 1] += first[e];
  return first;
}

std::size_t voxels_in(const VoxelPatches& cut)
{
  return cut.voxel.empty() ? 0 : std::size_t(*std::max_element(cut.voxel.begin(), cut.voxel.end())) + 1;
}

}  // namespace

TouchPatchTables::TouchPatchTables(const TouchTables& tables, const VoxelPatches& cut)
    : slide(static_cast<float>(near_vertex) * tables.sizes.edge),
      per_newton(tables.sizes.in_patches.per_newton),
      vertices(tables.vertices.size())
{
  add_vertices(tables, cut);
  add_near(tables);
}

void TouchPatchTables::add_vertices(const TouchTables& tables, const VoxelPatches& cut)
{
  const auto first = counted(tables.voxel, voxels_in(cut));
  copy_of.assign(cut.patches.size() * vertices, no_touch_copy);
  std::vector<char> published(vertices, 0);
  for (std::size_t p = 0; p < cut.patches.size(); ++p)
  {
    const Patch& patch = cut.patches[p];
    TouchPatch own{ static_cast<std::uint32_t>(vertex_of.size()), 0, static_cast<std::uint32_t>(voxels.size()), 0 };
    for (std::uint32_t v = 0; v < patch.voxels; ++v)
    {
      const std::uint32_t e = cut.voxel[patch.voxel_begin + v], begin = own.vertices;
      for (std::uint32_t w = first[e]; w < first[e + 1]; ++w, ++own.vertices)
      {
        uint4 words;
        static_assert(sizeof words == sizeof cut.corner[0], "eight places are read as four words");
        std::memcpy(&words, &cut.corner[patch.voxel_begin + v], sizeof words);
        corners.push_back(words);
        vertex_of.push_back(w | (published[w] != 0 ? 0 : touch_mark));
        published[w] = 1;
        copy_of[p * vertices + w] = static_cast<std::uint16_t>(own.vertices);
      }
      if (own.vertices > begin)
        voxels.push_back({ v, begin, own.vertices });
    }
    own.voxels = static_cast<std::uint32_t>(voxels.size()) - own.voxel_begin;
    patches.push_back(own);
  }
}

void TouchPatchTables::add_near(const TouchTables& tables)
{
  using Patches = std::vector<std::uint16_t>;
  std::vector<Patches> of_vertex(vertices);
  for (std::size_t p = 0; p < patches.size(); ++p)
    for (std::uint32_t i = 0; i < patches[p].vertices; ++i)
      of_vertex[vertex_of[patches[p].vertex_begin + i] & ~touch_mark].push_back(static_cast<std::uint16_t>(p));
  const auto unite = [](Patches& all)
  {
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
  };
  // Patches of the vertices of all triangles around each vertex, and vertices by cells.
  using Cell = std::array<int, 3>;
  std::vector<Patches> around(vertices);
  for (const TouchTriangle& triangle : tables.triangles)
    for (const std::int32_t v : triangle.vertex)
      for (const std::int32_t w : triangle.vertex)
        around[v].insert(around[v].end(), of_vertex[w].begin(), of_vertex[w].end());
  std::map<Cell, std::vector<std::size_t>> in_cell;
  const float farthest = 1.001F * slide;
  const auto cell = [&](const float4& at)
  {
    const auto index = [&](float x) { return static_cast<int>(std::floor(x / farthest)); };
    return Cell{ { index(at.x), index(at.y), index(at.z) } };
  };
  for (std::size_t v = 0; v < vertices; ++v)
  {
    unite(around[v]);
    in_cell[cell(tables.vertices[v].rest)].push_back(v);
  }
  const auto add = [&](const Patches& list)
  {
    near_begin.push_back(static_cast<std::uint32_t>(near.size()));
    near.insert(near.end(), list.begin(), list.end());
  };
  for (const Patches& list : of_vertex)
    add(list);
  std::size_t most = 0;
  std::vector<Patches> watched_by(patches.size());
  for (std::size_t v = 0; v < vertices; ++v)
  {
    const float4& here = tables.vertices[v].rest;
    const Cell at = cell(here);
    Patches list;
    for (int n = 0; n < 27; ++n)
      if (const auto found = in_cell.find({ { at[0] + n % 3 - 1, at[1] + n / 3 % 3 - 1, at[2] + n / 9 - 1 } });
          found != in_cell.end())
        for (const std::size_t other : found->second)
        {
          const float4& there = tables.vertices[other].rest;
          if (std::hypot(there.x - here.x, there.y - here.y, there.z - here.z) <= farthest)
            list.insert(list.end(), around[other].begin(), around[other].end());
        }
    unite(list);
    most = std::max(most, list.size());
    add(list);
    for (const std::uint16_t p : list)
      watched_by[p].insert(watched_by[p].end(), list.begin(), list.end());
  }
  for (std::size_t p = 0; p < patches.size(); ++p)
  {
    unite(watched_by[p]);
    watch_begin.push_back(static_cast<std::uint32_t>(watched.size()));
    std::copy_if(watched_by[p].begin(), watched_by[p].end(), std::back_inserter(watched),
                 [&](std::uint16_t q) { return q != p; });
  }
  watch_begin.push_back(static_cast<std::uint32_t>(watched.size()));
  near_begin.push_back(static_cast<std::uint32_t>(near.size()));
  for (const Patches& list : of_vertex)
    most_entries += list.size() + 2 * most;
}

DeviceTouchPatches::DeviceTouchPatches(const TouchPatchTables& tables)
    : slide_(tables.slide),
      per_newton_(tables.per_newton),
      patches_(tables.patches),
      corners_(tables.corners),
      vertex_of_(tables.vertex_of),
      near_begin_(tables.near_begin),
      watch_begin_(tables.watch_begin),
      counts_(2 * tables.patches.size()),
      lists_(tables.patches.size() * tables.vertices),
      entry_vertex_(tables.most_entries),
      voxels_(tables.voxels),
      copy_of_(tables.copy_of),
      near_(tables.near),
      watched_(tables.watched),
      entries_(tables.most_entries),
      before_(tables.vertex_of.size())
{
  for (auto& words : words_)
  {
    words = DeviceArray<float4>(touch_words * tables.vertices);
    words.clear();
  }
  for (auto& words : ended_)
  {
    words = DeviceArray<float4>(tables.patches.size());
    words.clear();
  }
}

TouchPatches DeviceTouchPatches::view() const
{
  return { patches_.data(),
           static_cast<std::uint32_t>(patches_.size()),
           corners_.data(),
           vertex_of_.data(),
           static_cast<std::uint32_t>(vertex_of_.size()),
           before_.data(),
           voxels_.data(),
           copy_of_.data(),
           near_begin_.data(),
           near_.data(),
           slide_,
           per_newton_,
           counts_.data(),
           lists_.data(),
           entries_.data(),
           entry_vertex_.data(),
           { words_[0].data(), words_[1].data() },
           watch_begin_.data(),
           watched_.data(),
           { ended_[0].data(), ended_[1].data() } };
}

std::size_t DeviceTouchPatches::bytes() const
{
  return patches_.bytes() + corners_.bytes() + vertex_of_.bytes() + near_begin_.bytes() + entry_vertex_.bytes() +
         voxels_.bytes() + copy_of_.bytes() + near_.bytes() + counts_.bytes() + lists_.bytes() + entries_.bytes() +
         before_.bytes() + words_[0].bytes() + words_[1].bytes() + watch_begin_.bytes() + watched_.bytes() +
         ended_[0].bytes() + ended_[1].bytes();
}

}  // namespace cuda
}  // namespace frontalis
