#pragma once

#include "bake/voxels/model_stages.hpp"

namespace frontalis
{

/// Fills the contacts of the model: the distance from each body, and the points of the tissue that may touch it. Throws
/// Error if a body is open, if nothing of a surface can be bound, or if the two overlap at rest.
void bind_contacts(const Scene& scene, const PreparedSurfaces& surfaces, const LocalFrame& frame, Model& model,
                   BakeMonitor& monitor);

/// The part of a surface in a box, its triangles halved until no edge is longer than `longest` [m], because only
/// vertices touch. Halves of an edge are the same for both of its triangles.
TriangleMesh refined(const TriangleMesh& surface, const Box& box, double longest);

}  // namespace frontalis
