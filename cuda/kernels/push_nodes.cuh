#pragma once

#include "cuda/kernels/bound_points.cuh"
#include "cuda/kernels/step_kernel.hpp"

namespace frontalis
{
namespace cuda
{

constexpr int push_block = 128;
constexpr std::uint32_t voxel_corners = 8;

/// What push_node() changes: velocities or internal forces of nodes.
struct PushTarget
{
  float factor;          ///< time by which accelerations are multiplied [s]
  const float4* masses;  ///< displacements with inverse masses
  float* v[3];           ///< velocities; null: `forces` change instead
  float4* forces;        ///< internal forces, to which the opposite of a node's force is added
};

/// Body of a kernel that passes forces on points on to nodes. Eight lanes process a node. Lane b sums of_point(p, b)
/// over the points p of the voxel whose corner b the node is: the part of each point's force that acts on this corner.
/// The sums of the eight lanes are then added in a fixed order. Calls wait(), which waits for the preceding kernel,
/// once constant data have been loaded.
template <class Wait, class OfPoint>
__device__ __forceinline__ void push_node(const BoundPoints& points, const PushTarget& to, const Wait& wait,
                                          const OfPoint& of_point)
{
  const std::uint32_t i = blockIdx.x * push_block + threadIdx.x, n = i / voxel_corners, b = i % voxel_corners;
  const bool inside = n < points.bound_count, writes = inside && b == 0;
  const std::int32_t index = inside ? points.node_voxels[i] : -1;
  BoundVoxel voxel{ 0, 0, 0 };
  if (index >= 0)
    voxel = points.voxels[index];
  const std::uint32_t node = writes ? points.bound[n] : 0;
  wait();
  // The node's values are loaded here, so that they arrive while forces are found.
  float gain = -1;
  physics::Vec3<float> value{ 0, 0, 0 };
  if (writes && to.v[0] == nullptr)
  {
    const float4 force = to.forces[node];
    value = { force.x, force.y, force.z };
  }
  else if (writes)
  {
    gain = to.factor * to.masses[node].w;
    value = { to.v[0][node], to.v[1][node], to.v[2][node] };
  }
  physics::Vec3<float> sum{ 0, 0, 0 };
#pragma unroll 2
  for (std::uint32_t p = voxel.first; p < voxel.end; ++p)
    sum = sum + of_point(p, b);
#pragma unroll
  for (int apart = 1; apart < int(voxel_corners); apart *= 2)
    sum = sum + physics::Vec3<float>{ __shfl_xor_sync(0xffffffffu, sum.x, apart),
                                      __shfl_xor_sync(0xffffffffu, sum.y, apart),
                                      __shfl_xor_sync(0xffffffffu, sum.z, apart) };
  if (!writes || (sum.x == 0 && sum.y == 0 && sum.z == 0))
    return;
  value = value + gain * sum;
  if (to.v[0] == nullptr)
  {
    to.forces[node] = make_float4(value.x, value.y, value.z, 0);
    return;
  }
  to.v[0][node] = value.x;
  to.v[1][node] = value.y;
  to.v[2][node] = value.z;
}

/// Number of blocks of a kernel that pushes nodes.
inline std::uint32_t push_blocks(const BoundPoints& points)
{
  return (voxel_corners * points.bound_count + push_block - 1) / push_block;
}

inline PushTarget push_target(const StepArguments& g, float factor, float* const (&v)[3])
{
  return { factor, g.u[g.first], { v[0], v[1], v[2] }, g.u[1 - g.first] };
}

}  // namespace cuda
}  // namespace frontalis
