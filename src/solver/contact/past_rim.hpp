#pragma once

#include "frontalis/solver/solver_state.hpp"
#include "solver/stepping/step_backend.hpp"

namespace frontalis
{

/// Counts the sliding nodes past the rim of their surface's field (Monitor::past_rim) at given displacements and poses
/// of bones, and names one that is far past the rim (Monitor::lost_node).
void find_nodes_past_rim(const Model& model, const NodalVectors& displacements,
                         const std::vector<RigidTransform>& bones, Monitor& monitor);

}  // namespace frontalis
