#pragma once

#include "bake/mesh/surface.hpp"

namespace frontalis
{

/// Throws Error if a surface or landmark called NAME_left lies to the right of NAME_right in the face frame. A face
/// that is mirrored, by its files or by its frame, would otherwise be baked without a word. Warns if left and right do
/// not lie beside each other in the face frame.
void check_sides(const Scene& scene, const PreparedSurfaces& surfaces, BakeMonitor& monitor);

}  // namespace frontalis
