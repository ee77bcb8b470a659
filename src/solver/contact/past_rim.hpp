#pragma once

#include "frontalis/solver/solver_state.hpp"
#include "solver/stepping/step_backend.hpp"

namespace frontalis
{

/// Counts the sliding nodes past the rim of their surface's field (Monitor::past_rim) at given displacements and poses
/// of bones, and names one that is far past the rim (Monitor::lost_node).
void find_nodes_past_rim(const Model& model, const NodalVectors& displacements,
                         const std::vector<RigidTransform>& bones, Monitor& monitor);

/// Largest distance [m] between the level of its surface at which a sliding node is and the one that it keeps. Infinite
/// if a node is where its surface has no samples.
double farthest_from_level(const Model& model, const NodalVectors& displacements,
                           const std::vector<RigidTransform>& bones);

/// Distance [m] of a sliding node from the nearest rest position of a node that slides on the same surface, in the
/// frame of the surface. If it is above usual_travel, the surface was not sampled there, whether it goes on or not.
double distance_from_rest(const Model& model, std::int32_t node, const NodalVectors& displacements,
                          const std::vector<RigidTransform>& bones);

}  // namespace frontalis
