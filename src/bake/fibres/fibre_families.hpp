#pragma once

#include "bake/voxels/local_frame.hpp"
#include "bake/mesh/surface.hpp"

#include <memory>
#include <vector>

namespace frontalis
{

/// Fills the model's material directions where a material's fibre families follow a surface: in each voxel they are
/// turned by the shortest rotation that takes the normal of their plane to the surface's normal at the point closest to
/// the voxel's centre. The sense of that normal is the one that most voxels of the material need turn less for. Where a
/// voxel has several such materials, the one of the largest proportion counts.
void turn_families(const Scene& scene, const std::vector<std::unique_ptr<PreparedSurface>>& surfaces,
                   const LocalFrame& frame, Model& model, BakeStages& stages);

}  // namespace frontalis
