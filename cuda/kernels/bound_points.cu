#include "cuda/kernels/bound_points.cuh"
#include "cuda/kernels/step_kernel.hpp"

namespace frontalis
{
namespace cuda
{

constexpr int block = 128;
constexpr std::uint32_t corners = 8;

struct Velocities
{
  float* v[3];
};

// Each lane adds up the forces on the points of one of a node's voxels. The sums of eight lanes are then added in a
// fixed order. `masses`: displacements with inverse masses. `forces`: internal forces, to which the opposite of the sum
// is added if `to` has no velocities.
__global__ void __launch_bounds__(block)
    push_nodes(const BoundPoints points, float factor, const float4* masses, const Velocities to, float4* forces)
{
  const std::uint32_t i = blockIdx.x * block + threadIdx.x, n = i / corners, b = i % corners;
  const bool inside = n < points.bound_count;
  const std::int32_t index = inside ? points.node_voxels[i] : -1;
  physics::Vec3<float> sum{ 0, 0, 0 };
  if (index >= 0)
  {
    const BoundVoxel voxel = points.voxels[index];
    for (std::uint32_t p = voxel.first; p < voxel.end; ++p)
    {
      const float4 at = points.coordinates[p];
      add_part(sum, corner_weight(b, at.x, at.y, at.z), points.pushes[p]);
    }
  }
#pragma unroll
  for (int apart = 1; apart < int(corners); apart *= 2)
    sum = sum + physics::Vec3<float>{ __shfl_xor_sync(0xffffffffu, sum.x, apart),
                                      __shfl_xor_sync(0xffffffffu, sum.y, apart),
                                      __shfl_xor_sync(0xffffffffu, sum.z, apart) };
  if (!inside || b > 0 || (sum.x == 0 && sum.y == 0 && sum.z == 0))
    return;
  const std::uint32_t node = points.bound[n];
  if (to.v[0] == nullptr)
  {
    float4& force = forces[node];
    force = make_float4(force.x - sum.x, force.y - sum.y, force.z - sum.z, 0);
    return;
  }
  const float gain = factor * masses[node].w;
  to.v[0][node] += gain * sum.x;
  to.v[1][node] += gain * sum.y;
  to.v[2][node] += gain * sum.z;
}

}  // namespace cuda

cudaError_t launch_push_nodes(const StepArguments& g, const BoundPoints& points, float factor, float* const (&v)[3],
                              cudaStream_t stream)
{
  const auto blocks = (cuda::corners * points.bound_count + cuda::block - 1) / cuda::block;
  cuda::push_nodes<<<blocks, cuda::block, 0, stream>>>(points, factor, g.u[g.first], { { v[0], v[1], v[2] } },
                                                       g.u[1 - g.first]);
  return cudaGetLastError();
}

}  // namespace frontalis
