#pragma once

#include "bake/voxels/voxelise.hpp"

namespace frontalis
{

/// Between scene and local coordinates: local axis a is scene axis (first + a) mod 3, the origin a node of the grid.
struct LocalFrame
{
  int first = 0;
  Vector3d origin{ 0, 0, 0 };  ///< scene coordinates [m]

  int scene_axis(int local) const { return (first + local) % 3; }
  /// Components along the local axes of what has components along the scene's axes.
  template <class T>
  std::array<T, 3> turn(const std::array<T, 3>& scene) const
  {
    return { scene[scene_axis(0)], scene[scene_axis(1)], scene[scene_axis(2)] };
  }
  Vector3d turn(const Vector3d& scene) const
  {
    return { scene[scene_axis(0)], scene[scene_axis(1)], scene[scene_axis(2)] };
  }
  Vector3d to_local(const Vector3d& scene) const { return turn(Vector3d(scene - origin)); }
  TriangleMesh to_local(TriangleMesh mesh) const
  {
    for (Vector3& v : mesh.vertices)
      v = to_array(to_local(to_vector(v)));
    return mesh;
  }
  Vector3d to_scene(const Vector3d& local) const
  {
    Vector3d p = origin;
    for (int a = 0; a < 3; ++a)
      p[scene_axis(a)] += local[a];
    return p;
  }
  /// Scene coordinates of the point (i, j, k) of the model's grid, in voxel edges from the origin.
  Vector3d grid_point(const Model& model, double i, double j, double k) const
  {
    return to_scene(to_vector(model.spacing).cwiseProduct(Vector3d(i, j, k)));
  }
  Vector3d voxel_centre(const Model& model, std::size_t e) const
  {
    const auto& v = model.voxels[e];
    return grid_point(model, v[0] + 0.5, v[1] + 0.5, v[2] + 0.5);
  }
};

// The stages of the bake that fill the model, in their order.

/// Chooses the axis along which rows of voxels are longest as local x, sorts the voxels, and fills the model's grid,
/// mixtures and muscle weights. Fibre directions come from add_fibres.
LocalFrame assemble_voxels(const Grid& grid, const Voxels& voxels, Model& model);

/// Copies what the bake does not compute from the scene into the model: frames, gravity, materials, muscles, accuracy
/// and presets.
void copy_settings(const Scene& scene, const LocalFrame& frame, Model& model);

/// Finds rigid, sliding and prescribed nodes and fills bones, constraint surfaces and loads of kind displacement.
///
/// A surface restricts a node that lies within `within` of it, or on its far side, seen from the tissue, by at most two
/// voxels. The tissue lies on the side of a surface where most of the tissue within two voxels of it is. A node that
/// several constraints want becomes rigid rather than prescribed, and prescribed rather than sliding; the first of
/// several rigid constraints counts, the nearest of several sliding surfaces. Throws Error for a constraint that
/// restricts no node.
void restrict_nodes(const Scene& scene, const PreparedSurfaces& surfaces, const LocalFrame& frame, Model& model,
                    BakeMonitor& monitor);

/// Removes loose parts. Parts are connected by faces of voxels; an edge or a corner is no connection. The largest part
/// stays, and every other one that has a restricted node and at least a hundredth of the largest one's voxels.
void remove_islands(Model& model, BakeMonitor& monitor);

/// Mixes the material of each layer that is too thin to be sampled into the voxels through which its surface passes.
/// Area of the surface in voxels that were left out counts for the voxel below. The proportion of the layer is the same
/// in all these voxels: its volume is right, and no voxel with little tissue becomes stiffer than the others, which
/// would shorten the time step.
void add_thin_layers(const Volumes& volumes, const LocalFrame& frame, Model& model, BakeMonitor& monitor);

/// Fills the model's material directions where a material's fibre families follow a surface. In each voxel the families
/// are turned by the shortest rotation from the normal of their plane to the surface's normal at the point closest to
/// the voxel's centre. Of the two normals of the plane it is the one that needs the smaller rotations in most voxels.
/// In a voxel with several such materials the one with the largest proportion counts.
void turn_families(const Scene& scene, const PreparedSurfaces& surfaces, const LocalFrame& frame, Model& model,
                   BakeMonitor& monitor);

/// Fills the skin, the landmarks and the loads of the model and binds their points to voxels. Throws Error if
/// nothing of a load can be bound, for a vertex of the skin that no voxel can carry, and for a landmark far from the
/// skin.
void bind_surfaces(const Scene& scene, const PreparedSurfaces& surfaces, const LocalFrame& frame, Model& model,
                   BakeMonitor& monitor);

/// Volumes of those muscles that are made of surfaces, in the order of the model's muscles.
std::vector<BakeReport::MuscleVolume> measure_muscles(const Volumes& volumes, const Model& model, BakeMonitor& monitor);

}  // namespace frontalis
