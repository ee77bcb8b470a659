#pragma once

#include "bake/voxels/local_frame.hpp"
#include "bake/mesh/surface.hpp"

#include <memory>
#include <vector>

namespace frontalis
{

/// Fills the model's material directions where a material's fibre families follow a surface. In each voxel the families
/// are turned by the shortest rotation from the normal of their plane to the surface's normal at the point closest to
/// the voxel's centre. Of the two normals of the plane it is the one that needs the smaller rotations in most voxels.
/// In a voxel with several such materials the one with the largest proportion counts.
void turn_families(const Scene& scene, const PreparedSurfaces& surfaces, const LocalFrame& frame, Model& model,
                   BakeMonitor& monitor);

}  // namespace frontalis
