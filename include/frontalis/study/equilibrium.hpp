#pragma once

#include "frontalis/solver/solver.hpp"
#include "frontalis/study/voxel_model.hpp"

#include <memory>

namespace frontalis
{

struct EquilibriumSettings
{
  Backend backend = "cpu";
  double period = 0;              ///< of the slowest vibration, about [s]
  double ramp = 1;                ///< periods over which loads and activations grow
  double tolerance = 1e-4;        ///< of Solver::settle
  double longest = 60;            ///< periods after which it is an Error
  float activation = 0;           ///< of every muscle
  RigidTransform bone_pose = {};  ///< of every bone
};

/// Model at rest under its loads.
struct RestState
{
  std::unique_ptr<Solver> solver;
  Vectors displacements;  ///< [m]
};

/// Brings the model to rest under slowly growing loads, critically damped for the period, and then by Solver::settle.
/// Throws Error if it is not at rest within settings.longest.
RestState find_equilibrium(Model model, const EquilibriumSettings& settings);

/// Mean displacement [m] of nodes, and the internal force [N] on them.
std::array<double, 3> mean_displacement(const Vectors& displacements, const std::vector<std::int32_t>& nodes);
std::array<double, 3> internal_force(Solver& solver, const std::vector<std::int32_t>& nodes);

}  // namespace frontalis
