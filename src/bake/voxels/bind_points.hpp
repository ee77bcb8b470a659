#pragma once

#include "bake/voxels/local_frame.hpp"
#include "bake/mesh/surface.hpp"
#include "bake/voxels/voxel_index.hpp"

#include <memory>
#include <vector>

namespace frontalis
{

/// Finds the voxel that a point follows: the one that contains it, else the nearest within the extrapolation distance.
class PointBinder
{
public:
  PointBinder(const Model& model, double extrapolation);

  /// False where no voxel is near enough. Coordinates in the voxel are 0..1 inside, along x, y, z.
  bool bind(const Vector3& local, std::int32_t& voxel, std::array<float, 3>& coordinates) const;

private:
  const Model& model_;
  VoxelIndex index_;
  double extrapolation_;
};

/// Fills skin, landmarks and loads on surfaces of the model, all bound. Throws Error where nothing of the skin or of a
/// load can be bound, and for a landmark far from the skin.
void bind_surfaces(const Scene& scene, const std::vector<std::unique_ptr<PreparedSurface>>& surfaces,
                   const LocalFrame& frame, Model& model, BakeStages& stages);

}  // namespace frontalis
