#pragma once

#include "bake/bake_monitor.hpp"
#include "bake/mesh/surface.hpp"
#include "bake/voxels/model_stages.hpp"

namespace frontalis
{

/// +1: the tissue within two voxels of a surface lies on the side of its outward normals, -1: on the other, 0: on both.
double tissue_side(const PreparedSurface& surface, const LocalFrame& frame, const Model& model);

/// The part of a surface that tissue faces, and what nodes that slide may reach beyond it: such as the outer table of
/// a bone, without the inner one. A closed sphere is returned whole. side: tissue_side().
TriangleMesh tissue_sheet(const PreparedSurface& surface, double side, const LocalFrame& frame, const Model& model);

/// Field of the distance from a surface's sheet (see SampledField) around nodes at `rest`, in local coordinates. Closed
/// spheres get their closed form.
SampledField distance_field(const PreparedSurface& surface, const PreparedSurface& sheet,
                            const std::vector<std::array<double, 3>>& rest, const LocalFrame& frame, const Model& model,
                            BakeMonitor& monitor);

}  // namespace frontalis
