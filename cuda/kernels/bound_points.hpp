#pragma once

#include <cuda_runtime_api.h>
#include <vector_types.h>

#include <cstdint>

namespace frontalis
{

/// Points [first, end) that are bound to a voxel. In a patch they count from the patch's first.
struct alignas(16) BoundVoxel
{
  std::uint32_t column;  ///< the voxel's number in its patch
  std::uint32_t first, end;
};

/// Forces on points that are bound to voxels, and where they go: for kernels beside the steps. Points are sorted by
/// voxel. Pointers are to device memory.
struct BoundPoints
{
  const float4* coordinates;        ///< of each point in its voxel
  const uint4* nodes;               ///< two per point: device nodes of its voxel
  float4* pushes;                   ///< force on each point [N]
  const BoundVoxel* voxels;         ///< those with points
  const std::uint32_t* bound;       ///< device nodes of these voxels
  const std::int32_t* node_voxels;  ///< per bound node, the voxels of which it is corner 0 .. 7; negative: none
  std::uint32_t point_count, bound_count;
};

struct StepArguments;

/// Adds `factor` [s] times the accelerations by points.pushes to the velocities `v` of nodes. `v` null: adds the
/// opposite of the forces to g.u[1 - g.first], which holds internal forces.
cudaError_t launch_push_nodes(const StepArguments& arguments, const BoundPoints& points, float factor,
                              float* const (&v)[3], cudaStream_t stream);

}  // namespace frontalis
