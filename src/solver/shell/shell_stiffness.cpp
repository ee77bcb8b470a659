#include "solver/shell/shell_stiffness.hpp"

#include "solver/contact/body_motion.hpp"
#include "solver/skin/bound_points.hpp"
#include "solver/stepping/bound_stiffness.hpp"
#include "solver/stepping/discretisation.hpp"

namespace frontalis
{
namespace
{

using Vector = physics::Vec3<double>;

}  // namespace

ShellStiffness::ShellStiffness(const Model& model, const Discretisation& discretisation) : mesh_(model)
{
  std::vector<double> of_voxels(model.nodes.size(), 0), rows(model.nodes.size(), 0);
  voxels_.resize(model.voxels.size());
  VoxelProperties properties;
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
  {
    discretisation.voxel(e, properties);
    voxels_[e] = static_cast<float>(properties.stiffness);
    for (const auto node : model.voxel_nodes[e])
      of_voxels[node] += properties.stiffness;
  }
  std::vector<float> stiffness(mesh_.binding.voxel.size(), 0);
  for (const ShellMesh::Triangle& t : mesh_.triangles)
    for (std::size_t i = 0; i < 6; ++i)
      stiffness[t.vertex[i]] += static_cast<float>((i < 3 ? t.membrane : 0) + t.bending);
  add_stiffness_rows(model, mesh_.binding, stiffness, 1, rows);
  share_rows(model, rows, of_voxels, voxels_);
}

void ShellStiffness::add_forces(const Model& model, const std::vector<std::array<double, 3>>& displacements,
                                std::vector<std::array<double, 3>>& forces) const
{
  std::vector<double> component[3];
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const auto& u : displacements)
      component[axis].push_back(u[axis]);
  const double* const u[3] = { component[0].data(), component[1].data(), component[2].data() };
  std::vector<Vector> moved, on_vertex(mesh_.binding.voxel.size());
  moved.reserve(on_vertex.size());
  for (std::size_t v = 0; v < on_vertex.size(); ++v)
    moved.push_back(vector_of(bound_displacement(model, mesh_.binding, v, u)));
  for (const ShellMesh::Triangle& t : mesh_.triangles)
  {
    const auto& rest = t.rest;
    const Vector a = moved[t.vertex[1]] - moved[t.vertex[0]], b = moved[t.vertex[2]] - moved[t.vertex[0]];
    const double stiffness = 2 * (rest.shear + rest.dilatation);
    const Vector on_a = stiffness * (rest.metric[0] * a + rest.metric[1] * b);
    const Vector on_b = stiffness * (rest.metric[1] * a + rest.metric[2] * b);
    on_vertex[t.vertex[0]] = on_vertex[t.vertex[0]] - (on_a + on_b);
    on_vertex[t.vertex[1]] = on_vertex[t.vertex[1]] + on_a;
    on_vertex[t.vertex[2]] = on_vertex[t.vertex[2]] + on_b;
    for (const auto v : t.vertex)
      on_vertex[v] = on_vertex[v] + t.bending * moved[v];
  }
  spread_forces(model, mesh_.binding, on_vertex, forces);
}

}  // namespace frontalis
