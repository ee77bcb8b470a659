#pragma once

#include "bake/voxels/volumes.hpp"

namespace frontalis
{

/// Whether a point lies in a volume, or which is the first of its conditions that fails.
enum class Membership
{
  inside,
  cropped,   ///< outside its crop
  beyond,    ///< outside the surfaces that bound it
  excluded,  ///< inside one of its `outside` or `without` surfaces
  wrong_depth,
  hidden  ///< an `outside` surface lies between the point and the surface from which its depth is measured
};

/// Finds it for a single point, without what speeds the sampling of voxels up: slow, and an independent check of it.
Membership membership(const Volumes& volumes, const Volumes::Entry& entry, const Vector3d& p);

/// Throws Error, with the length and place of the largest hole, for a volume whose surfaces are open in a way that does
/// harm: more than a tenth of what lies inside is so near to a hole that the winding number is below 3/4. Pinholes,
/// gaps and holes far from the volume (the neck of a head whose forehead is baked) are harmless.
void check_openings(const Scene& scene, const Volumes& volumes);

}  // namespace frontalis
