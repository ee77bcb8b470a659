#pragma once

#include "cuda/kernels/bound_points.cuh"
#include "cuda/kernels/step_kernel.hpp"

namespace frontalis
{
namespace cuda
{

constexpr int push_block = 128;
constexpr std::uint32_t voxel_corners = 8;

/// What changes by the forces on nodes.
struct PushTarget
{
  float factor;          ///< time by which accelerations are multiplied [s]
  const float4* masses;  ///< displacements with inverse masses
  float* v[3];           ///< velocities; null: `forces` change instead
  float4* forces;        ///< internal forces, to which the opposite of a node's force is added
};

/// Body of a kernel that pushes nodes. Each lane adds up the forces of_point(p, b) on corner b by the points p of one
/// of a node's voxels. The sums of eight lanes are then added in a fixed order.
template <class OfPoint>
__device__ __forceinline__ void push_node(const BoundPoints& points, const PushTarget& to, const OfPoint& of_point)
{
  const std::uint32_t i = blockIdx.x * push_block + threadIdx.x, n = i / voxel_corners, b = i % voxel_corners;
  const bool inside = n < points.bound_count;
  const std::int32_t index = inside ? points.node_voxels[i] : -1;
  physics::Vec3<float> sum{ 0, 0, 0 };
  if (index >= 0)
  {
    const BoundVoxel voxel = points.voxels[index];
    for (std::uint32_t p = voxel.first; p < voxel.end; ++p)
      sum = sum + of_point(p, b);
  }
#pragma unroll
  for (int apart = 1; apart < int(voxel_corners); apart *= 2)
    sum = sum + physics::Vec3<float>{ __shfl_xor_sync(0xffffffffu, sum.x, apart),
                                      __shfl_xor_sync(0xffffffffu, sum.y, apart),
                                      __shfl_xor_sync(0xffffffffu, sum.z, apart) };
  if (!inside || b > 0 || (sum.x == 0 && sum.y == 0 && sum.z == 0))
    return;
  const std::uint32_t node = points.bound[n];
  if (to.v[0] == nullptr)
  {
    float4& force = to.forces[node];
    force = make_float4(force.x - sum.x, force.y - sum.y, force.z - sum.z, 0);
    return;
  }
  const float gain = to.factor * to.masses[node].w;
  to.v[0][node] += gain * sum.x;
  to.v[1][node] += gain * sum.y;
  to.v[2][node] += gain * sum.z;
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
