#include "cuda/backend/device_shell.hpp"

#include "cuda/backend/device_model.hpp"
#include "cuda/kernels/shell_kernels.hpp"

#include "solver/shell/shell_energy.hpp"

#include <algorithm>
#include <cstring>
#include <numeric>
#include <utility>

namespace frontalis
{
namespace cuda
{
namespace
{

template <class T>
void sort_and_unite(std::vector<T>& list)
{
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

// For each voxel, the indices of the triangles with a vertex that is bound to it, ascending.
std::vector<std::vector<std::uint32_t>> triangles_at(const Model& model, const ShellMesh& mesh)
{
  std::vector<std::vector<std::uint32_t>> at(model.voxels.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (const auto v : mesh.triangles[t].vertex)
      if (auto& list = at[mesh.binding.voxel[v]]; list.empty() || list.back() != t)
        list.push_back(t);
  return at;
}

// The given triangles as words of 16 bytes, laid out as in ShellTriangles. `number`: for each vertex of the mesh, its
// index among the vertices whose displacements are computed.
std::vector<float4> words_of(const ShellMesh& mesh, const std::vector<std::uint32_t>& triangles,
                             const std::vector<std::int32_t>& number)
{
  std::vector<float4> words(shell_words * triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    const ShellMesh::Triangle& triangle = mesh.triangles[triangles[t]];
    const auto& rest = triangle.rest;
    std::vector<double> exact;
    for (const auto& x : rest.from_corner)
      exact.insert(exact.end(), { x.x, x.y, x.z });
    exact.insert(exact.end(), std::begin(rest.metric), std::end(rest.metric));
    exact.insert(exact.end(), { rest.inverse_area, rest.shear, rest.dilatation });
    exact.insert(exact.end(), std::begin(rest.height), std::end(rest.height));
    exact.insert(exact.end(), std::begin(rest.bending), std::end(rest.bending));
    exact.push_back(triangle.bending);
    float numbers[4 * shell_words] = {};
    std::transform(exact.begin(), exact.end(), numbers, [](double x) { return static_cast<float>(x); });
    std::int32_t vertex[6];
    std::transform(triangle.vertex.begin(), triangle.vertex.end(), vertex, [&](auto v) { return number[v]; });
    std::memcpy(numbers + 32, vertex, sizeof vertex);
    for (std::size_t w = 0; w < shell_words; ++w)
      std::memcpy(&words[w * triangles.size() + t], numbers + 4 * w, sizeof(float4));
  }
  return words;
}

// For each vertex whose displacement is computed, the indices of the x components of the triangles' forces on it, which
// are stored as [vertex][component][triangle]. `stride`: length of a row.
std::vector<std::vector<std::uint32_t>> terms_of(const ShellMesh& mesh, const std::vector<std::uint32_t>& triangles,
                                                 const std::vector<std::int32_t>& number, std::size_t vertices,
                                                 std::size_t stride)
{
  std::vector<std::vector<std::uint32_t>> terms(vertices);
  const auto count = static_cast<std::uint32_t>(triangles.size());
  for (std::uint32_t t = 0; t < count; ++t)
    for (std::uint32_t i = 0; i < 6; ++i)
      if (const auto& triangle = mesh.triangles[triangles[t]]; i < 3 || triangle.has_beyond(i - 3))
        terms[number[triangle.vertex[i]]].push_back(static_cast<std::uint32_t>(3 * i * stride + t));
  return terms;
}

// Appends values to a table of words of 16 bytes, and pads the last word with zeros.
template <class T>
void append(std::vector<uint4>& table, const std::vector<T>& values)
{
  const std::size_t bytes = values.size() * sizeof(T), at = table.size();
  table.resize(at + (bytes + sizeof(uint4) - 1) / sizeof(uint4), uint4{ 0, 0, 0, 0 });
  if (bytes > 0)
    std::memcpy(&table[at], values.data(), bytes);
}

// Number of threads that find forces of shells in a block, if the largest patches have so many voxels and triangles:
// that with which the slower of both takes least time.
std::uint32_t shell_threads(std::uint32_t voxels, std::uint32_t triangles)
{
  // Time that a thread takes for one of them, relative to each other. It was chosen to minimise the wall time per step
  // of the generated foreheads.
  constexpr std::uint32_t voxel_time = 3, triangle_time = 2;
  const auto rounds = [](std::uint32_t items, std::uint32_t threads) { return (items + threads - 1) / threads; };
  std::pair<std::uint32_t, std::uint32_t> least{ ~0u, 0 };
  std::uint32_t best = 0;
  for (std::uint32_t threads = 32; threads < most_patch_threads; threads += 32)
  {
    const std::uint32_t one = voxel_time * rounds(voxels, most_patch_threads - threads),
                        other = triangle_time * rounds(triangles, threads);
    const std::pair time(std::max(one, other), std::min(one, other));
    if (time < least)
    {
      least = time;
      best = threads;
    }
  }
  return best;
}

}  // namespace

std::vector<std::vector<std::int32_t>> voxels_beside(const Model& model, const ShellMesh& mesh)
{
  std::vector<std::vector<std::int32_t>> beside(model.voxels.size());
  for (const ShellMesh::Triangle& triangle : mesh.triangles)
    for (const auto v : triangle.vertex)
      for (const auto other : triangle.vertex)
        beside[mesh.binding.voxel[v]].push_back(mesh.binding.voxel[other]);
  for (auto& list : beside)
    sort_and_unite(list);
  return beside;
}

ShellTables::ShellTables(const Model& model, const ShellMesh& mesh, const VoxelPatches& cut,
                         const std::vector<std::uint32_t>& device_node)
    : blocks_(cut.blocks)
{
  const Around around = triangles_at(model, mesh);
  for (std::size_t p = 0; p < cut.patches.size(); ++p)
    add(model, mesh, around, cut, p, device_node);
}

void ShellTables::add(const Model& model, const ShellMesh& mesh, const Around& around, const VoxelPatches& cut,
                      std::size_t index, const std::vector<std::uint32_t>& device_node)
{
  const Patch& of = cut.patches[index];
  const auto& binding = mesh.binding;
  std::vector<std::int32_t> number(binding.voxel.size(), -1), vertices;
  const auto add_vertex = [&](std::int32_t v)
  {
    if (number[v] >= 0)
      return;
    number[v] = static_cast<std::int32_t>(vertices.size());
    vertices.push_back(v);
  };
  std::vector<uint2> voxels;
  std::vector<std::uint32_t> triangles;
  for (std::uint32_t column = 0; column < of.voxels; ++column)
  {
    const auto e = static_cast<std::int32_t>(cut.voxel[of.voxel_begin + column]);
    const auto [begin, end] = std::equal_range(binding.voxel.begin(), binding.voxel.end(), e);
    if (begin == end)
      continue;
    voxels.push_back(
        { column, static_cast<std::uint32_t>(vertices.size()) | static_cast<std::uint32_t>(end - begin) << 16 });
    for (auto v = begin; v != end; ++v)
      add_vertex(static_cast<std::int32_t>(v - binding.voxel.begin()));
    triangles.insert(triangles.end(), around[e].begin(), around[e].end());
  }
  const std::size_t own = vertices.size();
  sort_and_unite(triangles);
  for (const auto t : triangles)
    for (const auto v : mesh.triangles[t].vertex)
      add_vertex(v);

  const auto terms = terms_of(mesh, triangles, number, vertices.size(), triangles.size() + 1);
  const auto none = static_cast<std::uint16_t>(triangles.size());
  std::vector<float4> coordinates;
  std::vector<std::array<std::uint16_t, 8>> corners;
  std::vector<std::uint16_t> all_terms;
  for (std::size_t v = 0; v < vertices.size(); ++v)
  {
    // Vertices in voxels of other patches get no terms: some of the triangles around them are missing here.
    const std::size_t count = v < own ? (terms[v].size() + 3) / 4 : 0;
    const auto sum = static_cast<std::uint32_t>(all_terms.size() / 4 | count << 20);
    const auto& at = binding.coordinates[vertices[v]];
    coordinates.push_back({ at[0], at[1], at[2], 0 });
    std::memcpy(&coordinates.back().w, &sum, sizeof sum);
    corners.emplace_back();
    const auto& nodes = model.voxel_nodes[binding.voxel[vertices[v]]];
    std::transform(nodes.begin(), nodes.end(), corners.back().begin(),
                   [&](auto n) { return static_cast<std::uint16_t>(cut.place_of(index, device_node[n])); });
    for (std::size_t k = 0; k < 4 * count; ++k)
      all_terms.push_back(k < terms[v].size() ? static_cast<std::uint16_t>(terms[v][k]) : none);
  }
  const auto begin = static_cast<std::uint32_t>(tables.size());
  append(tables, coordinates);
  append(tables, corners);
  append(tables, voxels);
  append(tables, all_terms);
  patches.push_back({ begin, static_cast<std::uint32_t>(tables.size()) - begin,
                      static_cast<std::uint32_t>(vertices.size()), static_cast<std::uint32_t>(own),
                      static_cast<std::uint32_t>(voxels.size()), static_cast<std::uint32_t>(triangles.size()) });
  append(tables, words_of(mesh, triangles, number));
  fits_indices_ = fits_indices_ && vertices.size() < 1u << 16 && 18 * (triangles.size() + 1) < 1u << 16;
}

void ShellTables::add_room(std::uint32_t most_voxels, PartRoom& all) const
{
  std::vector<std::uint32_t> table(blocks_, 0), triangles(blocks_, 0);
  std::uint32_t most = 0;
  for (std::size_t p = 0; p < patches.size(); ++p)
  {
    const PatchShell& patch = patches[p];
    table[p % blocks_] += patch.table_words;
    triangles[p % blocks_] += shell_words * patch.triangles;
    all.room.shell_words = std::max(all.room.shell_words, patch.vertices + (18 * (patch.triangles + 1) + 3) / 4);
    most = std::max(most, patch.triangles);
  }
  all.room.shell_threads = shell_threads(most_voxels, most);
  all.threads = std::max(all.threads, (most_voxels + 31) / 32 * 32 + all.room.shell_threads);
  all.room.table_words = *std::max_element(table.begin(), table.end());
  all.triangle_words = *std::max_element(triangles.begin(), triangles.end());
  all.fits_indices = all.fits_indices && fits_indices_;
}

DeviceShell::DeviceShell(const Model& model, const VoxelCut& cut, const std::vector<std::uint32_t>& device_node)
    : model_(model), mesh_(model)
{
  if (!cut.patches)
  {
    add_to_strips(device_node);
    return;
  }
  const ShellTables tables(model, mesh_, *cut.patches, device_node);
  patches_ = DeviceArray<PatchShell>(tables.patches);
  tables_ = DeviceArray<uint4>(tables.tables);
}

void DeviceShell::add_to_strips(const std::vector<std::uint32_t>& device_node)
{
  std::vector<std::uint32_t> triangles(mesh_.triangles.size());
  std::iota(triangles.begin(), triangles.end(), 0u);
  std::vector<std::int32_t> number(mesh_.binding.voxel.size());
  std::iota(number.begin(), number.end(), 0);
  std::vector<float4> coordinates;
  for (const auto& at : mesh_.binding.coordinates)
    coordinates.push_back({ at[0], at[1], at[2], 0 });
  std::vector<uint2> sums;
  std::vector<std::uint32_t> terms;
  for (const auto& of_vertex : terms_of(mesh_, triangles, number, number.size(), triangles.size()))
  {
    sums.push_back({ static_cast<std::uint32_t>(terms.size()), static_cast<std::uint32_t>(of_vertex.size()) });
    terms.insert(terms.end(), of_vertex.begin(), of_vertex.end());
  }
  points_ =
      DeviceBoundPoints(model_, { mesh_.binding.voxel.begin(), mesh_.binding.voxel.end() }, coordinates, device_node);
  words_ = DeviceArray<float4>(words_of(mesh_, triangles, number));
  sums_ = DeviceArray<uint2>(sums);
  terms_ = DeviceArray<std::uint32_t>(terms);
  moved_ = DeviceArray<float4>(number.size());
  forces_ = DeviceArray<float>(18 * triangles.size());
}

void DeviceShell::describe(StepArguments& g) const { g.shell = { patches_.data(), tables_.data(), false }; }

void DeviceShell::list_arrays(ArrayList& list)
{
  const Effect effect = Effect::shell;
  list.add(effect, "triangles", mesh_.triangles);
  list.add(effect, "triangles", words_.bytes() + tables_.bytes());
  list.add(effect, "vertices", mesh_.binding.voxel);
  list.add(effect, "vertices", mesh_.binding.coordinates);
  list.add(effect, "vertices", patches_.bytes() + points_.bytes());
  list.add(effect, "sums", sums_.bytes() + terms_.bytes());
  list.add(effect, "forces", moved_.bytes() + forces_.bytes());
}

void DeviceShell::find_pushes(const StepArguments& g, int /*step*/, cudaStream_t stream) const
{
  const auto count = static_cast<std::uint32_t>(mesh_.triangles.size());
  require(launch_shell_forces({ words_.data(), count, g.shell.spring }, { sums_.data(), terms_.data() }, points_.view(),
                              g.u[g.first], moved_.data(), forces_.data(), stream),
          "finding forces of shells");
}

void DeviceShell::add_energies(const std::vector<double> (&u)[3], const std::vector<RigidTransform>& /*bones*/,
                               bool /*open*/, Vectors& forces, EnergyLedger& ledger)
{
  const double* const pointers[3] = { u[0].data(), u[1].data(), u[2].data() };
  add_shell_energies(model_, mesh_, pointers, forces, ledger);
}

}  // namespace cuda
}  // namespace frontalis
