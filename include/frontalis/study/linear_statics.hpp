#pragma once

#include "frontalis/study/voxel_model.hpp"

#include <array>
#include <memory>

namespace frontalis
{

/// Small displacements about a homogeneous deformation. The stiffness is the tangent of the solver's own internal
/// forces, assembled and factorised directly, so that an error of the result is one of the element and not of a motion
/// that has not come to rest. Element matrices are central differences of the reference solver's forces; equal voxels
/// share one.
class LinearStatics
{
public:
  /// `gradient`: deformation gradient, row by row, of the state to linearise about. Rigid nodes and the components that
  /// model.prescribed names are fixed. Throws Error if the model has muscles or sliding nodes.
  explicit LinearStatics(const Model& model, const std::array<double, 9>& gradient = { { 1, 0, 0, 0, 1, 0, 0, 0, 1 } });
  ~LinearStatics();

  /// Whether the state is stable: all pivots of the factorisation were positive.
  bool positive_definite() const;

  /// Displacements [m] under nodal forces [N] and the prescribed displacements. Throws Error if the state is
  /// unstable.
  Vectors solve(const Vectors& forces) const;

private:
  struct System;
  std::unique_ptr<System> system_;
};

/// Forces [N] on the nodes of a plane of the grid (axis, index) that amount to a uniform traction [Pa] on it.
Vectors face_forces(const Model& model, int axis, std::int32_t index, const std::array<double, 3>& traction);

}  // namespace frontalis
