#pragma once

#include "frontalis/solver/solver.hpp"
#include "frontalis/study/voxel_model.hpp"

#include <memory>

namespace frontalis
{

struct EquilibriumSettings
{
  Backend backend = "cpu";
  double period = 0;        ///< of the slowest vibration, about [s]
  double tolerance = 1e-4;  ///< of Solver::settle
  float activation = 0;     ///< of every muscle
  double ramp = 1;          ///< periods over which loads and activations grow
};

/// Model at rest under its loads.
struct RestState
{
  std::unique_ptr<Solver> solver;
  Vectors displacements;  ///< [m]
};

/// Brings the model to rest under slowly growing loads, critically damped for the period, and then by Solver::settle.
/// Throws Error if it is not at rest within 60 periods.
RestState find_equilibrium(Model model, const EquilibriumSettings& settings);

/// Mean displacement [m] of nodes, and the internal force [N] on them.
Point mean_displacement(const Vectors& displacements, const std::vector<std::int32_t>& nodes);
Point internal_force(Solver& solver, const std::vector<std::int32_t>& nodes);

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
Vectors face_forces(const Model& model, int axis, std::int32_t index, const Point& traction);

}  // namespace frontalis
