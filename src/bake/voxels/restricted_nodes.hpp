#pragma once

#include "bake/voxels/local_frame.hpp"
#include "bake/mesh/surface.hpp"

#include <memory>
#include <vector>

namespace frontalis
{

/// Finds rigid, sliding and prescribed nodes and fills bones, constraint surfaces and loads of kind displacement.
///
/// A node is restricted where it lies within `within` of the surface, or beyond it, seen from the tissue, by no more
/// than two voxels. The tissue's side of a surface is where most tissue within two voxels of it is. Rigid wins over
/// prescribed, prescribed over sliding; of several rigid constraints the first, of several sliding surfaces the
/// nearest. Throws Error for a constraint that catches no node.
void restrict_nodes(const Scene& scene, const std::vector<std::unique_ptr<PreparedSurface>>& surfaces,
                    const LocalFrame& frame, Model& model, BakeStages& stages);

/// Removes voxels that do not belong: of the components that hang together by faces the largest is kept, and every
/// other one that has a restricted node and at least a hundredth of the largest one's voxels. (What hangs on by an edge
/// or a corner alone is a component of its own.)
void remove_islands(Model& model, BakeStages& stages);

}  // namespace frontalis
