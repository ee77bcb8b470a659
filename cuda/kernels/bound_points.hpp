#pragma once

#include <cuda_runtime_api.h>
#include <vector_types.h>

#include <cstdint>

namespace frontalis
{

/// A voxel to which the points [first, end) are bound. In a patch they are counted from the patch's first point.
struct alignas(16) BoundVoxel
{
  std::uint32_t column;  ///< index of the voxel in its patch
  std::uint32_t first, end;
};

/// Forces on points that are bound to voxels, and the nodes to which they are passed on, for kernels that run in
/// addition to the step kernel. Points are sorted by voxel. Pointers are to device memory.
struct BoundPoints
{
  const float4* coordinates;        ///< coordinates of each point in its voxel
  const uint4* nodes;               ///< two words per point: device nodes of its voxel
  float4* pushes;                   ///< force on each point [N]
  const BoundVoxel* voxels;         ///< the voxels that have points
  const std::uint32_t* bound;       ///< device nodes of these voxels
  const std::int32_t* node_voxels;  ///< per bound node, the voxels whose corner 0 .. 7 the node is; negative: none
  std::uint32_t point_count, bound_count;
};

struct StepArguments;

/// Multiplies the accelerations that points.pushes cause by `factor` [s] and adds them to the velocities `v` of nodes.
/// If v[0] is null, adds the opposite of the forces to the internal forces in g.u[1 - g.first] instead.
cudaError_t launch_push_nodes(const StepArguments& arguments, const BoundPoints& points, float factor,
                              float* const (&v)[3], cudaStream_t stream);

}  // namespace frontalis
