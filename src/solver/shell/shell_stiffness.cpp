#include "solver/shell/shell_stiffness.hpp"

#include "solver/stepping/bound_stiffness.hpp"
#include "solver/stepping/discretisation.hpp"

namespace frontalis
{
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

double ShellStiffness::energy_at_rest() const
{
  const physics::Vec3<double> none[6]{};
  double sum = 0;
  for (const ShellMesh::Triangle& t : mesh_.triangles)
  {
    const auto at_rest = physics::shell_forces(t.rest, none);
    sum += at_rest.membrane + at_rest.bending;
  }
  return sum;
}

std::vector<PointStiffness> ShellStiffness::matrices() const
{
  PointStiffness matrix{ &mesh_.binding, {} };
  for (const ShellMesh::Triangle& t : mesh_.triangles)
  {
    const auto& [aa, ab, bb] = t.rest.metric;
    const double of_corners[3][3] = { { aa + 2 * ab + bb, -aa - ab, -ab - bb },
                                      { -aa - ab, aa, ab },
                                      { -ab - bb, ab, bb } };
    const double stiffness = 2 * (t.rest.shear + t.rest.dilatation);
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        matrix.entries.push_back({ t.vertex[i], t.vertex[j], stiffness * of_corners[i][j] });
    for (const auto v : t.vertex)
      matrix.entries.push_back({ v, v, t.bending });
  }
  return { matrix };
}

}  // namespace frontalis
