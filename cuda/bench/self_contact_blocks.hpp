#pragma once

#include "frontalis/study/voxel_model.hpp"

namespace frontalis
{

/// Two blocks of 35 x 35 x `height` voxels, one above the other and one voxel edge (1 mm) apart. The lower side of the
/// lower block is held, and the upper side of the upper block is held 1.03 mm lower than at rest, so that the facing
/// sides, which have 5,042 points together, overlap. Without `contact` they pass through each other.
Model touching_blocks(std::int32_t height, bool contact, double friction = 0);

/// Displacements with which the blocks touch everywhere.
Vectors touching_start(const Model& model);

}  // namespace frontalis
