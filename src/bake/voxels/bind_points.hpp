#pragma once

#include "bake/voxels/local_frame.hpp"
#include "bake/mesh/surface.hpp"
#include "bake/voxels/voxel_index.hpp"

#include <memory>
#include <vector>

namespace frontalis
{

/// Finds the voxel that a point follows: the one that contains it, or the nearest within the extrapolation distance.
class PointBinder
{
public:
  PointBinder(const Model& model, double extrapolation);

  /// False where no voxel is near enough. Coordinates in a voxel run from 0 to 1 along each of its edges.
  bool bind(const Vector3d& local, std::int32_t& voxel, std::array<float, 3>& coordinates) const;

private:
  const Model& model_;
  VoxelIndex index_;
  double extrapolation_;
};

/// A mesh in local coordinates, and its vertices bound to voxels.
struct BoundMesh
{
  TriangleMesh mesh;
  Binding binding;
  std::size_t triangles = 0;    ///< inside the crop
  std::size_t too_far = 0;      ///< of these, with a vertex too far from every voxel
  Vector3d unbound{ 0, 0, 0 };  ///< such a vertex, scene coordinates [m]
};
/// Of a surface in scene coordinates, those triangles in the crop whose vertices can all be bound.
BoundMesh bind_mesh(const TriangleMesh& whole, const Region& crop, const LocalFrame& frame, const PointBinder& binder,
                    BakeMonitor& monitor);
/// How far a point may lie outside its voxel [m].
double extrapolation_of(const Scene& scene, const Model& model);

/// Fills the skin, the landmarks and the loads of the model and binds their points to voxels. Throws Error if
/// nothing of a load can be bound, for a vertex of the skin that no voxel can carry, and for a landmark far from the
/// skin.
void bind_surfaces(const Scene& scene, const PreparedSurfaces& surfaces, const LocalFrame& frame, Model& model,
                   BakeMonitor& monitor);

}  // namespace frontalis
