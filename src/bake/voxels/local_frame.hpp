#pragma once

#include "bake/voxels/voxelise.hpp"

namespace frontalis
{

/// Between scene and local coordinates: local axis a is scene axis (first + a) mod 3, the origin a node of the grid.
struct LocalFrame
{
  int first = 0;
  Vector3 origin{ 0, 0, 0 };  ///< scene coordinates [m]

  std::size_t scene_axis(std::size_t local) const { return (static_cast<std::size_t>(first) + local) % 3; }
  /// Components of a direction of the scene along the local axes.
  template <class T>
  std::array<T, 3> turn(const std::array<T, 3>& scene) const
  {
    return { scene[scene_axis(0)], scene[scene_axis(1)], scene[scene_axis(2)] };
  }
  Vector3 to_local(const Vector3& scene) const { return turn(scene - origin); }
  TriangleMesh to_local(TriangleMesh mesh) const
  {
    for (Vector3& v : mesh.vertices)
      v = to_local(v);
    return mesh;
  }
};

/// Orders the voxels, chooses the axis with the longest rows on average as local x and fills the model's grid, mixtures
/// and muscle weights (directions come from add_fibres).
LocalFrame assemble_voxels(const Grid& grid, const Voxels& voxels, Model& model);

/// Gives every voxel that a thin layer's surface passes through its share of the layer: thickness times the surface's
/// area in the voxel, of the tissue there. Area in voxels that were dropped goes to the voxel below.
void add_thin_layers(const Volumes& volumes, const LocalFrame& frame, Model& model, BakeStages& stages);

/// to_scene, to_face, gravity, materials, muscles, time, presets.
void copy_settings(const Scene& scene, const LocalFrame& frame, Model& model);

}  // namespace frontalis
