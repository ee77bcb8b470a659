#pragma once

#include "solver/stepping/discretisation.hpp"
#include "frontalis/physics/voxel_element.hpp"
#include "frontalis/solver/solver.hpp"

#include <array>
#include <vector>

namespace frontalis
{

/// Bound of the largest eigenvalue of a voxel's stiffness [N/m] at a deformation, NaN where that is not finite.
double stiffness_now(const Discretisation& discretisation, const VoxelProperties& voxel,
                     const physics::Kinematics<double>& k);

/// Energies and the worst voxel at given nodal displacements [m] and velocities [m/s].
Monitor monitor_voxels(const Model& model, const Discretisation& discretisation,
                       const std::vector<std::array<double, 3>>& u, const std::vector<std::array<double, 3>>& v);

}  // namespace frontalis
