#pragma once

#include "frontalis/solver/shell_mesh.hpp"
#include "solver/stepping/added_stiffness.hpp"

namespace frontalis
{

class Discretisation;

/// Stiffness of layers that are shells, and its contribution to the bound of the highest frequency.
class ShellStiffness : public AddedStiffness
{
public:
  /// `discretisation`: its bounds of the voxels' stiffness must not include the shells yet.
  ShellStiffness(const Model& model, const Discretisation& discretisation);

  double in_voxel(std::size_t voxel) const override { return double(voxels_[voxel]); }
  /// An upper bound of the shells' stiffness. Each triangle has the stiffness of its stiffest direction in all
  /// directions; in addition, each of its vertices has a spring that is stiffer than the triangle in bending.
  std::vector<PointStiffness> matrices() const override;
  double energy_at_rest() const override;

private:
  ShellMesh mesh_;
  std::vector<float> voxels_;  // [N/m]
};

}  // namespace frontalis
