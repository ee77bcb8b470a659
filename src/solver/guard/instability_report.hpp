#pragma once

#include "frontalis/solver/guard.hpp"

namespace frontalis
{

/// A sliding node past the rim of its surface's field.
struct LostNode
{
  std::int32_t node = -1;
  double strayed = 0;  ///< its distance_from_rest() [m]
};

/// Describes a voxel's position and materials, and the most likely cause of the instability there. `moved`: whether
/// each bone has moved since the last good check; `activation`: activation of each muscle; `lost`: of a finding
/// past_rim.
InstabilityReport describe(const Model& model, Instability kind, double time, std::int32_t voxel, double jacobian,
                           const std::vector<float>& activation, const std::vector<bool>& moved,
                           const LostNode& lost = {});

}  // namespace frontalis
