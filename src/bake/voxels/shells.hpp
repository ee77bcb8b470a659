#pragma once

#include "bake/voxels/model_stages.hpp"

namespace frontalis
{

/// Makes the layers that are shells; adjacent ones become one shell of the same stiffness. Surfaces are meshed anew
/// with edges of 1.2 voxels. Shorter edges would take kinks for bending, because bound points move with kinks at the
/// faces of voxels. Throws Error if no part of a layer can be bound.
void bind_shells(const Scene& scene, const PreparedSurfaces& surfaces, const LocalFrame& frame, Model& model,
                 BakeMonitor& monitor);

}  // namespace frontalis
