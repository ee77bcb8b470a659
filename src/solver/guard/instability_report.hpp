#pragma once

#include "frontalis/solver/guard.hpp"

namespace frontalis
{

/// Describes a voxel's position and materials, and the most likely cause of the instability there. `moved`: whether
/// each bone has moved since the last good check; `activation`: activation of each muscle; `strayed`:
/// distance_from_rest() of a sliding node without a surface [m].
InstabilityReport describe(const Model& model, Instability kind, double time, std::int32_t voxel, double jacobian,
                           const std::vector<float>& activation, const std::vector<bool>& moved, double strayed = 0);

}  // namespace frontalis
