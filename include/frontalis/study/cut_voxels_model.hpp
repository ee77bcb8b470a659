#pragma once

#include "frontalis/study/voxel_model.hpp"

namespace frontalis
{

/// Makes each voxel have its stress at the centroid of its tissue, which is found from samples^3 points. `inside`:
/// whether a point is in the tissue.
void cut_at_surface(Model& model, const Condition& inside, int samples);

}  // namespace frontalis
