#pragma once

#include "frontalis/study/voxel_model.hpp"

namespace frontalis
{

/// Small displacements about a homogeneous deformation: the tangent of the solver's own internal forces, assembled and
/// factorised (banded Cholesky), so that what is verified is the element and not how a motion comes to rest. Element
/// matrices are central differences of the reference solver's forces; equal voxels share one.
class LinearStatics
{
public:
  /// `gradient`: deformation gradient, row by row, of the state to linearise about. Fixed are rigid nodes and the
  /// components that model.prescribed names. Throws Error where the model has muscles or sliding nodes.
  explicit LinearStatics(const Model& model, const std::array<double, 9>& gradient = { { 1, 0, 0, 0, 1, 0, 0, 0, 1 } });

  /// True where every pivot was positive: the state is stable.
  bool positive_definite() const { return positive_definite_; }

  /// Displacements [m] under nodal forces [N], with the prescribed displacements in place.
  Vectors solve(const Vectors& forces) const;

private:
  void assemble(const Model& model, const std::array<double, 9>& gradient);
  void factorise();
  void back_substitute(std::vector<double>& x) const;

  std::vector<std::array<std::int32_t, 3>> unknown_;  // of a node's components; -1: fixed
  Vectors fixed_;                                     // prescribed displacements
  std::vector<double> right_;                         // forces that these bring with them
  std::vector<double> band_;                          // column j: rows j .. j + width_
  std::size_t count_ = 0, width_ = 0;
  bool positive_definite_ = true;
};

/// Forces [N] on the nodes of a plane of the grid (axis, index) that stand for a uniform traction [Pa] on all of it.
Vectors face_forces(const Model& model, int axis, std::int32_t index, const std::array<double, 3>& traction);

}  // namespace frontalis
