#pragma once

#include "bake/bake_monitor.hpp"
#include "bake/voxels/volumes.hpp"

namespace frontalis
{

/// Warns of holes in mesh files, within the tissue, that are probably faults: in surfaces that tissue is outside of,
/// such as bones, and in the skin on one side of the face alone. Holes of eyes and mouth have a counterpart on the
/// other side or lie in the middle. Sides are those of the pairs of surfaces NAME_left and NAME_right.
void check_holes(const Scene& scene, const PreparedSurfaces& surfaces, const Volumes& volumes, BakeMonitor& monitor);

}  // namespace frontalis
