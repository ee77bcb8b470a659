#include "cuda/kernels/contact_kernels.hpp"

#include "cuda/kernels/contact_points.cuh"

namespace frontalis
{
namespace cuda
{

// In strips, contact has kernels of its own, which run before each step. Its forces change the velocities of nodes.

constexpr int block = 128;

__global__ void __launch_bounds__(block) find_pushes(const __grid_constant__ StepArguments g, int step)
{
  const std::uint32_t p = blockIdx.x * block + threadIdx.x;
  if (p >= g.contact.point_count)
    return;
  const ContactPoint point = g.contact.points[p];
  const BoundPoints& bound = g.contact.bound;
  const physics::Vec3<float> moved =
      bound_displacement(bound.coordinates[p], bound.nodes[2 * p], bound.nodes[2 * p + 1], g.u[g.first]);
  const physics::Vec3<float> force = find_push(g, point, { p, step, true, moved }).force;
  bound.pushes[p] = make_float4(force.x, force.y, force.z, 0);
}

}  // namespace cuda

cudaError_t launch_find_pushes(const StepArguments& arguments, int step, cudaStream_t stream)
{
  const auto blocks = (arguments.contact.point_count + cuda::block - 1) / cuda::block;
  cuda::find_pushes<<<blocks, cuda::block, 0, stream>>>(arguments, step);
  return cudaGetLastError();
}

}  // namespace frontalis
