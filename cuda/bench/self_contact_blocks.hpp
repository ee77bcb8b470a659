#pragma once

#include "frontalis/study/voxel_model.hpp"

namespace frontalis
{

/// Two blocks of 35 x 35 x `height` voxels, one above the other and one voxel edge (1 mm) apart, whose outer sides are
/// held. Facing sides, of 5,042 points together, may touch if `contact`. The upper side of the upper block is held
/// where it presses the blocks together if they are to touch (touching_start()).
Model touching_blocks(std::int32_t height, bool contact, double friction = 0);

/// Displacements with which the blocks touch everywhere.
Vectors touching_start(const Model& model);

}  // namespace frontalis
