#pragma once

#include "frontalis/solver/guard.hpp"

namespace frontalis
{

/// Says of a voxel where it is, what it is made of and what most likely went wrong there. `moved`: one a bone, whether
/// it moved lately; activation: one a muscle.
InstabilityReport describe(const Model& model, Instability kind, double time, std::int32_t voxel, double jacobian,
                           const std::vector<float>& activation, const std::vector<bool>& moved);

}  // namespace frontalis
