#pragma once

#include "frontalis/study/voxel_model.hpp"

namespace frontalis
{

/// Moves the point where each voxel's stress is computed to the centroid of the voxel's tissue, which is found from
/// samples^3 points. `inside`: whether a point is in the tissue.
void cut_at_surface(Model& model, const Condition& inside, int samples);

}  // namespace frontalis
