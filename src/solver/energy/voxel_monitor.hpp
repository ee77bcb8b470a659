#pragma once

#include "solver/stepping/discretisation.hpp"
#include "frontalis/solver/solver.hpp"

#include <array>
#include <vector>

namespace frontalis
{

/// Energies, and the voxel with the smallest J, at given nodal displacements [m] and velocities [m/s]. `mobility`: of
/// every node, for the bound (step_bound.hpp).
Monitor monitor_voxels(const Model& model, const Discretisation& discretisation,
                       const std::vector<std::array<double, 3>>& u, const std::vector<std::array<double, 3>>& v,
                       const std::vector<float>& mobility);

}  // namespace frontalis
