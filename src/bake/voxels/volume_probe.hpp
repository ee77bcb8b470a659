#pragma once

#include "bake/voxels/volumes.hpp"

namespace frontalis
{

/// Where a point stands to a volume: inside, or the first of its conditions that fails.
enum class Standing
{
  inside,
  cropped,   ///< outside its crop
  beyond,    ///< outside the surfaces that bound it
  too_deep,  ///< not at its depth
  excluded,  ///< inside one of its `outside` or `without` surfaces
  hidden     ///< behind one of these, seen from the surface that depth is measured from
};

/// Asks the surfaces about one point at a time, without the shortcuts of the voxels: slow, and an independent check.
Standing standing(const Volumes& volumes, const Volumes::Entry& entry, const Vector3& p);

/// Whether a body holds the point: winding number above a half.
bool holds(const Volumes::Solid& solid, const Vector3& p);

/// Refuses volumes whose surfaces are really open: where more than a tenth of what lies inside is so near to a hole
/// that the winding number is below 3/4. Pinholes, gaps, and holes far from the volume (the neck of a head whose
/// forehead is baked) do no harm. Throws Error with the largest hole's length and place.
void check_openings(const Scene& scene, const Volumes& volumes);

}  // namespace frontalis
