#pragma once

#include "bake/voxels/model_stages.hpp"

namespace frontalis
{

/// Fills the contacts of the model: the distance from each body, and the points of the tissue that may touch it. Throws
/// Error if a body is open, if no part of a surface can be bound, or if body and tissue overlap at rest.
void bind_contacts(const Scene& scene, const PreparedSurfaces& surfaces, const LocalFrame& frame, Model& model,
                   BakeMonitor& monitor);

}  // namespace frontalis
