#pragma once

#include "bake/voxels/model_stages.hpp"

namespace frontalis
{

/// Fills the surfaces of the model that touch each other, oriented so that tissue is behind them. Throws Error if no
/// part of a surface can be bound, or if it is not a boundary of the tissue.
void bind_self_contacts(const Scene& scene, const PreparedSurfaces& surfaces, const LocalFrame& frame, Model& model,
                        BakeMonitor& monitor);

}  // namespace frontalis
