#pragma once

#include "frontalis/solver/solver.hpp"
#include "frontalis/study/voxel_model.hpp"

#include <memory>

namespace frontalis
{

struct EquilibriumSettings
{
  Backend backend = "cpu";
  double period = 0;              ///< approximate period of the slowest vibration [s]
  double tolerance = 1e-4;        ///< tolerance of Solver::settle()
  float activation = 0;           ///< activation of every muscle, 0..1
  double ramp = 1;                ///< number of periods over which loads and activations grow
  RigidTransform bone_pose = {};  ///< pose of every bone at the end of the ramp
};

/// A model at rest under its loads.
struct RestState
{
  std::unique_ptr<Solver> solver;
  Vectors displacements;  ///< [m]
};

/// Lets loads and activations grow, with critical damping for the given period, and then calls Solver::settle().
/// Throws Error if the model is not at rest within 60 periods.
RestState find_equilibrium(Model model, const EquilibriumSettings& settings);

/// Mean displacement [m] of nodes, and the sum of internal forces [N] on them.
Point mean_displacement(const Vectors& displacements, const std::vector<std::int32_t>& nodes);
Point internal_force(Solver& solver, const std::vector<std::int32_t>& nodes);

/// Statics of small displacements about a homogeneous deformation. The stiffness is the tangent of the solver's own
/// internal forces, assembled and factorised directly, so that errors come from the elements alone and not from
/// incomplete settling. Element matrices are central differences of the reference solver's forces and of the law of
/// shells.
class LinearStatics
{
public:
  /// `gradient`: deformation gradient, row by row, of the state to linearise about. Rigid nodes and the components that
  /// model.prescribed names are fixed. Throws Error if the model has muscles or sliding nodes.
  explicit LinearStatics(const Model& model, const std::array<double, 9>& gradient = { { 1, 0, 0, 0, 1, 0, 0, 0, 1 } });
  /// Statics of a model's shells alone, about their shape at rest. Their vertices are free of the voxels that carry
  /// them; `fixed` has the components that are held, for each vertex of ShellMesh. Throws Error if the model has no
  /// shells, or if `fixed` has another size.
  LinearStatics(const Model& model, const std::vector<std::array<bool, 3>>& fixed);
  ~LinearStatics();

  /// Whether the state is stable, that is whether all pivots of the factorisation were positive.
  bool positive_definite() const;

  /// Displacements [m] under forces [N] on nodes, or on vertices, and the prescribed displacements. Throws Error in an
  /// unstable state, or if there is not one force for each node or vertex.
  Vectors solve(const Vectors& forces) const;

private:
  struct System;
  std::unique_ptr<System> system_;
};

/// Forces [N] on the nodes of a plane of the grid (axis, index) that are equivalent to a uniform traction [Pa].
Vectors face_forces(const Model& model, int axis, std::int32_t index, const Point& traction);

}  // namespace frontalis
