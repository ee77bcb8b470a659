#pragma once

#include "bake/voxels/model_stages.hpp"

namespace frontalis
{

/// Makes the layers that are shells; those that lie on each other become one of the same stiffness. Their triangles are
/// new: edges are 1.2 times a voxel's, because bound points move with kinks at the faces of voxels, and edges shorter
/// than voxels would find bending in them. Throws Error if nothing of a layer can be bound.
void bind_shells(const Scene& scene, const PreparedSurfaces& surfaces, const LocalFrame& frame, Model& model,
                 BakeMonitor& monitor);

}  // namespace frontalis
