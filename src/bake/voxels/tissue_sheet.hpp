#pragma once

#include "bake/bake_monitor.hpp"
#include "bake/mesh/surface.hpp"
#include "bake/voxels/model_stages.hpp"

namespace frontalis
{

/// The part of a surface that faces tissue, extended by the distance that sliding nodes may move beyond it: the outer
/// table of a bone, for example, without the inner one. A closed sphere is returned unchanged. side: where the tissue
/// is, +1: on the side of the outward normals, -1: on the other, 0: on both.
TriangleMesh tissue_sheet(const PreparedSurface& surface, double side, const LocalFrame& frame, const Model& model);

/// Field of the distance from a surface's sheet (see SampledField) around nodes at `rest`, in local coordinates. Closed
/// spheres get their closed form.
SampledField distance_field(const PreparedSurface& surface, const PreparedSurface& sheet,
                            const std::vector<std::array<double, 3>>& rest, const LocalFrame& frame, const Model& model,
                            BakeMonitor& monitor);

}  // namespace frontalis
