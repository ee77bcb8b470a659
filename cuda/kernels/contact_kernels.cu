#include "cuda/kernels/contact_kernels.hpp"

#include "cuda/kernels/contact_points.cuh"

namespace frontalis
{
namespace cuda
{

// In strips, contact has kernels of its own before each step. Its forces become changes of the nodes' velocities.

constexpr int block = 128;
constexpr std::uint32_t corners = 8;

__global__ void __launch_bounds__(block) find_pushes(const __grid_constant__ StepArguments g, int step)
{
  const std::uint32_t p = blockIdx.x * block + threadIdx.x;
  if (p >= g.contact.point_count)
    return;
  const ContactPoint point = g.contact.points[p];
  const uint4 low = g.contact.nodes[2 * p], high = g.contact.nodes[2 * p + 1];
  const std::uint32_t node[corners] = { low.x, low.y, low.z, low.w, high.x, high.y, high.z, high.w };
  float weight[corners];
  physics::trilinear_weights(point.coordinates[0], point.coordinates[1], point.coordinates[2], weight);
  physics::Vec3<float> moved{ 0, 0, 0 };
#pragma unroll
  for (std::uint32_t b = 0; b < corners; ++b)
    add_part(moved, weight[b], g.u[g.first][node[b]]);
  const physics::Vec3<float> force = find_push(g, point, { p, step, true, moved }).force;
  g.contact.pushes[p] = make_float4(force.x, force.y, force.z, 0);
}

struct Velocities
{
  float* v[3];
};

// Each lane adds up the points of one of the node's voxels. The sums of eight lanes are added in a fixed order.
__global__ void __launch_bounds__(block)
    push_nodes(const __grid_constant__ StepArguments g, float factor, const Velocities to)
{
  const std::uint32_t i = blockIdx.x * block + threadIdx.x, n = i / corners, b = i % corners;
  const bool inside = n < g.contact.bound_count;
  const std::int32_t index = inside ? g.contact.node_voxels[i] : -1;
  physics::Vec3<float> sum{ 0, 0, 0 };
  if (index >= 0)
  {
    const ContactVoxel voxel = g.contact.voxels[index];
    for (std::uint32_t p = voxel.first; p < voxel.end; ++p)
    {
      const auto& at = g.contact.points[p].coordinates;
      add_part(sum, corner_weight(b, at[0], at[1], at[2]), g.contact.pushes[p]);
    }
  }
#pragma unroll
  for (int apart = 1; apart < int(corners); apart *= 2)
    sum = sum + physics::Vec3<float>{ __shfl_xor_sync(0xffffffffu, sum.x, apart),
                                      __shfl_xor_sync(0xffffffffu, sum.y, apart),
                                      __shfl_xor_sync(0xffffffffu, sum.z, apart) };
  if (!inside || b > 0 || (sum.x == 0 && sum.y == 0 && sum.z == 0))
    return;
  const std::uint32_t node = g.contact.bound[n];
  if (to.v[0] == nullptr)
  {
    float4& force = g.u[1 - g.first][node];
    force = make_float4(force.x - sum.x, force.y - sum.y, force.z - sum.z, 0);
    return;
  }
  const float gain = factor * g.u[g.first][node].w;
  to.v[0][node] += gain * sum.x;
  to.v[1][node] += gain * sum.y;
  to.v[2][node] += gain * sum.z;
}

}  // namespace cuda

cudaError_t launch_find_pushes(const StepArguments& arguments, int step, cudaStream_t stream)
{
  const auto blocks = (arguments.contact.point_count + cuda::block - 1) / cuda::block;
  cuda::find_pushes<<<blocks, cuda::block, 0, stream>>>(arguments, step);
  return cudaGetLastError();
}

cudaError_t launch_push_nodes(const StepArguments& arguments, float factor, float* const (&v)[3], cudaStream_t stream)
{
  const auto blocks = (cuda::corners * arguments.contact.bound_count + cuda::block - 1) / cuda::block;
  cuda::push_nodes<<<blocks, cuda::block, 0, stream>>>(arguments, factor, { { v[0], v[1], v[2] } });
  return cudaGetLastError();
}

}  // namespace frontalis
