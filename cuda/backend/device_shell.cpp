#include "cuda/backend/device_shell.hpp"

#include "cuda/backend/device_model.hpp"
#include "cuda/kernels/shell_kernels.hpp"

#include "solver/shell/shell_energy.hpp"

#include <algorithm>
#include <cstring>
#include <numeric>

namespace frontalis
{
namespace cuda
{
namespace
{

// Lists of the triangles around the vertices of each voxel, ascending.
std::vector<std::vector<std::uint32_t>> triangles_at(const Model& model, const ShellMesh& mesh)
{
  std::vector<std::vector<std::uint32_t>> at(model.voxels.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (const auto v : mesh.triangles[t].vertex)
      if (auto& list = at[mesh.binding.voxel[v]]; list.empty() || list.back() != t)
        list.push_back(t);
  return at;
}

template <class T>
void sort_and_unite(std::vector<T>& list)
{
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
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

ShellTables::ShellTables(const Model& model, const ShellMesh& mesh, const VoxelPatches* cut,
                         const std::vector<std::uint32_t>& device_node)
{
  const Around around = triangles_at(model, mesh);
  if (cut == nullptr)
  {
    Voxels all(model.voxels.size());
    std::iota(all.begin(), all.end(), 0u);
    add(model, mesh, around, all, [&](std::int32_t node) { return device_node[node]; });
  }
  for (std::size_t p = 0; cut != nullptr && p < cut->patches.size(); ++p)
  {
    const Patch& patch = cut->patches[p];
    const auto voxel = cut->voxel.begin() + patch.voxel_begin;
    add(model, mesh, around, Voxels(voxel, voxel + patch.voxels),
        [&](std::int32_t node) { return cut->place_of(p, device_node[node]); });
  }
  pack(mesh);
}

void ShellTables::add(const Model& model, const ShellMesh& mesh, const Around& around, const Voxels& of_patch,
                      const std::function<std::uint32_t(std::int32_t node)>& place)
{
  const auto& binding = mesh.binding;
  PatchShell patch{ static_cast<std::uint32_t>(corners.size() / 2), 0, static_cast<std::uint32_t>(triangles.size()), 0,
                    static_cast<std::uint32_t>(voxels.size()),      0 };
  std::vector<std::int32_t> number(binding.voxel.size(), -1);  // of each vertex in the patch
  std::vector<std::int32_t> vertices;
  const auto add_vertex = [&](std::int32_t v)
  {
    if (number[v] >= 0)
      return;
    number[v] = static_cast<std::int32_t>(vertices.size());
    vertices.push_back(v);
  };
  std::vector<std::uint32_t> needed;
  for (std::uint32_t column = 0; column < of_patch.size(); ++column)
  {
    const auto e = static_cast<std::int32_t>(of_patch[column]);
    const auto [begin, end] = std::equal_range(binding.voxel.begin(), binding.voxel.end(), e);
    if (begin == end)
      continue;
    const auto first = static_cast<std::uint32_t>(vertices.size());
    for (auto v = begin; v != end; ++v)
      add_vertex(static_cast<std::int32_t>(v - binding.voxel.begin()));
    voxels.push_back({ column, first, static_cast<std::uint32_t>(vertices.size()) });
    needed.insert(needed.end(), around[e].begin(), around[e].end());
  }
  const std::size_t own = vertices.size();
  sort_and_unite(needed);
  for (const auto t : needed)
    for (const auto v : mesh.triangles[t].vertex)
      add_vertex(v);
  for (const auto t : needed)
    add_triangle(mesh, t, number);
  patch.vertices = static_cast<std::uint32_t>(vertices.size());
  patch.triangles = static_cast<std::uint32_t>(needed.size());
  patch.voxels = static_cast<std::uint32_t>(voxels.size()) - patch.voxel_begin;

  std::vector<std::vector<std::uint32_t>> terms_of(vertices.size());
  for (std::uint32_t t = 0; t < needed.size(); ++t)
    for (std::uint32_t i = 0; i < 6; ++i)
      if (const auto& triangle = mesh.triangles[needed[t]]; i < 3 || triangle.has_beyond(i - 3))
        terms_of[number[triangle.vertex[i]]].push_back(3 * i * patch.triangles + t);
  for (std::size_t v = 0; v < vertices.size(); ++v)
  {
    const auto& at = binding.coordinates[vertices[v]];
    coordinates.push_back({ at[0], at[1], at[2], 0 });
    const auto& nodes = model.voxel_nodes[binding.voxel[vertices[v]]];
    for (const std::size_t half : { 0, 4 })
      corners.push_back({ place(nodes[half]), place(nodes[half + 1]), place(nodes[half + 2]), place(nodes[half + 3]) });
    // the others lack triangles
    if (v >= own)
      terms_of[v].clear();
    sums.push_back({ static_cast<std::uint32_t>(terms.size()), static_cast<std::uint32_t>(terms_of[v].size()) });
    terms.insert(terms.end(), terms_of[v].begin(), terms_of[v].end());
  }
  patches.push_back(patch);
  most_words = std::max(most_words, patch.vertices + (18 * patch.triangles + 3) / 4);
  most_triangles = std::max(most_triangles, patch.triangles);
}

void ShellTables::add_triangle(const ShellMesh& mesh, std::uint32_t triangle, const std::vector<std::int32_t>& number)
{
  triangles.push_back(triangle);
  vertices_.emplace_back();
  for (std::size_t i = 0; i < 6; ++i)
    vertices_.back()[i] = static_cast<std::uint32_t>(number[mesh.triangles[triangle].vertex[i]]);
}

void ShellTables::pack(const ShellMesh& mesh)
{
  words.resize(shell_words * triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    const ShellMesh::Triangle& triangle = mesh.triangles[triangles[t]];
    const auto& rest = triangle.rest;
    std::vector<float> numbers;
    for (const auto& x : rest.from_corner)
      for (const double component : { x.x, x.y, x.z })
        numbers.push_back(static_cast<float>(component));
    for (const double x : { rest.metric[0], rest.metric[1], rest.metric[2], rest.inverse_area, rest.shear,
                            rest.dilatation, rest.height[0], rest.height[1], rest.height[2] })
      numbers.push_back(static_cast<float>(x));
    for (const double x : rest.bending)
      numbers.push_back(static_cast<float>(x));
    numbers.push_back(static_cast<float>(triangle.bending));
    numbers.resize(4 * shell_words, 0);
    std::memcpy(&numbers[32], vertices_[t].data(), sizeof vertices_[t]);
    for (std::size_t w = 0; w < shell_words; ++w)
      std::memcpy(&words[w * triangles.size() + t], &numbers[4 * w], sizeof(float4));
  }
}

DeviceShell::DeviceShell(const Model& model, const VoxelCut& cut, const std::vector<std::uint32_t>& device_node)
    : model_(model), mesh_(model)
{
  const ShellTables tables(model, mesh_, cut.patches.get(), device_node);
  patches_ = DeviceArray<PatchShell>(tables.patches);
  corners_ = DeviceArray<uint4>(tables.corners);
  coordinates_ = DeviceArray<float4>(tables.coordinates);
  words_ = DeviceArray<float4>(tables.words);
  sums_ = DeviceArray<uint2>(tables.sums);
  terms_ = DeviceArray<std::uint32_t>(tables.terms);
  voxels_ = DeviceArray<BoundVoxel>(tables.voxels);
  if (cut.patches)
    return;
  all_ = tables.patches[0];
  points_ = DeviceBoundPoints(model, { mesh_.binding.voxel.begin(), mesh_.binding.voxel.end() }, tables.coordinates,
                              device_node);
  moved_ = DeviceArray<float4>(all_.vertices);
  forces_ = DeviceArray<float>(std::size_t{ 18 } * all_.triangles);
}

void DeviceShell::describe(StepArguments& g) const
{
  g.shell = { patches_.data(),
              corners_.data(),
              coordinates_.data(),
              sums_.data(),
              terms_.data(),
              words_.data(),
              static_cast<std::uint32_t>(words_.size() / shell_words),
              voxels_.data(),
              false };
}

void DeviceShell::list_arrays(ArrayList& list)
{
  const Effect effect = Effect::shell;
  list.add(effect, "triangles", mesh_.triangles);
  list.add(effect, "triangles", words_.bytes());
  list.add(effect, "vertices", mesh_.binding.voxel);
  list.add(effect, "vertices", mesh_.binding.coordinates);
  list.add(effect, "vertices", patches_.bytes() + corners_.bytes() + coordinates_.bytes() + voxels_.bytes());
  list.add(effect, "sums", sums_.bytes() + terms_.bytes());
  list.add(effect, "forces", points_.bytes() + moved_.bytes() + forces_.bytes());
}

void DeviceShell::find_pushes(const StepArguments& g, int /*step*/, cudaStream_t stream) const
{
  require(launch_shell_forces(g.shell, all_, points(), g.u[g.first], moved_.data(), forces_.data(), stream),
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
