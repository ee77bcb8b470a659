#pragma once

#include "frontalis/study/voxel_model.hpp"

namespace frontalis
{

/// Gives each voxel the stress at the centroid of what is inside, found from samples^3 points.
void cut_at_surface(Model& model, const Condition& inside, int samples);

}  // namespace frontalis
