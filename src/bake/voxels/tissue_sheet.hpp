#pragma once

#include "bake/bake_monitor.hpp"
#include "bake/mesh/surface.hpp"
#include "bake/voxels/model_stages.hpp"

namespace frontalis
{

/// Whether a surface is stored as centre and radius.
bool is_sphere(const PreparedSurface& surface);

/// The side of a surface on which the tissue within two voxels lies. +1: that of its normals, -1: the other, 0: both.
double tissue_side(const PreparedSurface& surface, const LocalFrame& frame, const Model& model);

/// The part of a surface that faces tissue, such as the outer table of a bone, extended by the distance that sliding
/// nodes may move beyond it. A closed sphere is returned unchanged. `side`: see tissue_side(). `bones`: other surfaces
/// that restrict nodes; parts that face one of them within a voxel, such as the wall of a suture, are left out.
TriangleMesh tissue_sheet(const PreparedSurface& surface, double side, const std::vector<const PreparedSurface*>& bones,
                          const LocalFrame& frame, const Model& model);

/// A surface that nodes slide on, and its part that faces tissue.
struct SlidingSurface
{
  const PreparedSurface* whole;
  const PreparedSurface* sheet;
};

/// Field of the distance from the sheets of surfaces that move alike (see SampledField), around nodes at `rest` in
/// local coordinates. It is smooth where one sheet continues another. A closed sphere has a field of its own, in closed
/// form.
SampledField distance_field(const std::vector<SlidingSurface>& surfaces, const std::vector<std::array<double, 3>>& rest,
                            const LocalFrame& frame, const Model& model, BakeMonitor& monitor);

}  // namespace frontalis
