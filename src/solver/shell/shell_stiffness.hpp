#pragma once

#include "frontalis/solver/shell_mesh.hpp"
#include "solver/stepping/added_stiffness.hpp"

namespace frontalis
{

class Discretisation;

/// Stiffness of layers that are shells, and what it adds to the bound of the highest frequency.
class ShellStiffness : public AddedStiffness
{
public:
  /// `discretisation`: with bounds of the voxels' stiffness that do not include the shells.
  ShellStiffness(const Model& model, const Discretisation& discretisation);

  double in_voxel(std::size_t voxel) const override { return double(voxels_[voxel]); }
  /// Each triangle has an equal stiffness against all gradients of displacement, that of its stiffest, and each of its
  /// vertices one against displacements, which exceeds that of bending.
  void add_forces(const Model& model, const std::vector<std::array<double, 3>>& displacements,
                  std::vector<std::array<double, 3>>& forces) const override;

private:
  ShellMesh mesh_;
  std::vector<float> voxels_;  // [N/m]
};

}  // namespace frontalis
