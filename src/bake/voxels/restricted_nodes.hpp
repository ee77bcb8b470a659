#pragma once

#include "bake/voxels/local_frame.hpp"
#include "bake/mesh/surface.hpp"

#include <memory>
#include <vector>

namespace frontalis
{

/// Finds rigid, sliding and prescribed nodes and fills bones, constraint surfaces and loads of kind displacement.
///
/// A surface restricts a node that lies within `within` of it, or on its far side, seen from the tissue, by at most two
/// voxels. The tissue lies on the side of a surface where most of the tissue within two voxels of it is. A node that
/// several constraints want becomes rigid rather than prescribed, and prescribed rather than sliding; the first of
/// several rigid constraints counts, the nearest of several sliding surfaces. Throws Error for a constraint that
/// restricts no node.
void restrict_nodes(const Scene& scene, const PreparedSurfaces& surfaces, const LocalFrame& frame, Model& model,
                    BakeMonitor& monitor);

/// Removes loose parts. Parts are connected by faces of voxels; an edge or a corner is no connection. The largest part
/// stays, and every other one that has a restricted node and at least a hundredth of the largest one's voxels.
void remove_islands(Model& model, BakeMonitor& monitor);

}  // namespace frontalis
