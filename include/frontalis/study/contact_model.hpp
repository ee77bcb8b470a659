#pragma once

#include "frontalis/study/voxel_model.hpp"

namespace frontalis
{

// Bodies that voxel models touch, for studies and tests.

/// A body with a plane surface at height z [m]: a sphere so large that its curvature is negligible. `side`: -1 if the
/// body is below its surface, +1 if it is above.
SampledField flat_body(double z, int side);

/// The lowest or highest side along z of a box of full voxels, as the points that may touch a body. Each square of the
/// side has a point at its centre, so that a uniform pressure gives each of the square's nodes a quarter of its force.
Contact touching_side(const Model& model, bool upper, SampledField body);

}  // namespace frontalis
