#pragma once

#include "frontalis/solver/guard.hpp"

namespace frontalis
{

/// Describes where a voxel is, what it is made of, and what most likely went wrong there. `moved`: whether each bone
/// has moved lately; activation: of each muscle.
InstabilityReport describe(const Model& model, Instability kind, double time, std::int32_t voxel, double jacobian,
                           const std::vector<float>& activation, const std::vector<bool>& moved);

}  // namespace frontalis
