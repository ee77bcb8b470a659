#include "solver/cpu/gather_tiles.hpp"

#include <algorithm>
#include <iterator>

namespace frontalis
{
namespace
{

// What some voxels have and others do not: a kind, and up to two indices within it.
enum Kind : std::int32_t
{
  muscle,
  law,
  viscous,
  cut
};
using Part = std::array<std::int32_t, 3>;
using Parts = std::vector<Part>;  // ascending

struct Strip
{
  std::int32_t first, count;  // voxels
  Parts parts;
};

void add_parts(const Model& model, std::int32_t e, const VoxelProperties& voxel, Parts& parts)
{
  for (auto f = model.fibre_begin[e]; f < model.fibre_begin[e + 1]; ++f)
    parts.push_back({ { muscle, model.fibre_muscle[f], 0 } });
  for (const LawPart& part : voxel.laws)
    parts.push_back({ { law, static_cast<std::int32_t>(part.law), part.material } });
  if (voxel.viscous_share[0] > 0 || voxel.viscous_share[1] > 0)
    parts.push_back({ { viscous, 0, 0 } });
  if (voxel.centre.x != 0 || voxel.centre.y != 0 || voxel.centre.z != 0)
    parts.push_back({ { cut, 0, 0 } });
}

// The voxels of a plane in strips: runs of neighbours along x.
std::vector<Strip> make_strips(const Model& model, std::int32_t first, std::int32_t last,
                               const VoxelProperties* properties)
{
  std::vector<Strip> strips;
  for (auto e = first; e < last; ++e)
  {
    const bool goes_on = !strips.empty() && strips.back().count < Tile::strip &&
                         model.voxels[e][1] == model.voxels[e - 1][1] &&
                         model.voxels[e][0] == model.voxels[e - 1][0] + 1;
    if (!goes_on)
      strips.push_back({ e, 0, {} });
    ++strips.back().count;
    add_parts(model, e, properties[e - first], strips.back().parts);
  }
  for (Strip& strip : strips)
  {
    std::sort(strip.parts.begin(), strip.parts.end());
    strip.parts.erase(std::unique(strip.parts.begin(), strip.parts.end()), strip.parts.end());
  }
  return strips;
}

Parts joined(const Parts& a, const Parts& b)
{
  Parts all;
  std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(all));
  return all;
}

// One or two strips that share a tile.
struct Pair
{
  const Strip *one, *other;  // `other` may be null
  Parts parts;
};

// Pairs strips with the same parts, then the others with those that add the fewest parts.
std::vector<Pair> pair_up(std::vector<Strip>& strips)
{
  std::stable_sort(strips.begin(), strips.end(), [](const Strip& a, const Strip& b) { return a.parts < b.parts; });
  std::vector<Pair> pairs;
  std::vector<const Strip*> single;
  for (auto begin = strips.begin(); begin != strips.end();)
  {
    const auto end = std::find_if(begin, strips.end(), [&](const Strip& s) { return s.parts != begin->parts; });
    const auto half = (end - begin) / 2;
    for (auto i = begin; i < begin + half; ++i)
      pairs.push_back({ &*i, &*(i + half), i->parts });
    if ((end - begin) % 2 == 1)
      single.push_back(&*(end - 1));
    begin = end;
  }
  while (!single.empty())
  {
    Pair pair{ single.back(), nullptr, single.back()->parts };
    single.pop_back();
    auto best = single.end();
    for (auto s = single.begin(); s != single.end(); ++s)
      if (Parts all = joined(pair.one->parts, (*s)->parts); best == single.end() || all.size() <= pair.parts.size())
      {
        best = s;
        pair.parts = std::move(all);
      }
    if (best != single.end())
    {
      pair.other = *best;
      single.erase(best);
    }
    pairs.push_back(std::move(pair));
  }
  return pairs;
}

}  // namespace

std::vector<Tile> gather_tiles(const Model& model, std::int32_t first, std::int32_t last,
                               const VoxelProperties* properties)
{
  std::vector<Strip> strips = make_strips(model, first, last, properties);
  std::vector<Pair> pairs = pair_up(strips);
  // Tiles with the same code follow each other, so that the processor predicts its branches.
  const auto code = [](const Pair& pair)
  { return std::make_pair(pair.parts.empty() ? muscle : pair.parts.back()[0], pair.parts.size()); };
  std::stable_sort(pairs.begin(), pairs.end(), [&](const Pair& a, const Pair& b) { return code(a) < code(b); });
  std::vector<Tile> tiles;
  for (const Pair& pair : pairs)
  {
    Tile tile{};
    for (int s = 0; s < Tile::strips; ++s)
    {
      // An empty strip has the nodes of the first one. It adds zeros to the forces there, because its lanes have no
      // stiffness.
      const Strip& strip = s == 1 && pair.other != nullptr ? *pair.other : *pair.one;
      tile.first_voxel[s] = strip.first;
      tile.count[s] = s == 1 && pair.other == nullptr ? 0 : strip.count;
      for (int row = 0; row < 4; ++row)
        tile.node[s][row] = model.voxel_nodes[strip.first][2 * row];
    }
    tiles.push_back(tile);
  }
  return tiles;
}

}  // namespace frontalis
