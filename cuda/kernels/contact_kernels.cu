#include "cuda/kernels/contact_kernels.hpp"

#include "cuda/kernels/contact_points.cuh"
#include "cuda/kernels/pushed_bodies.cuh"

namespace frontalis
{
namespace cuda
{

// In strips, contact has kernels of its own, which run before each step. Its forces change the velocities of nodes.

constexpr int block = 128, warp = 32;

// Each block moves a body.
__global__ void __launch_bounds__(warp)
    move_bodies(const PushedBodies pushed, int step, double dt, std::uint32_t body_count)
{
  move_body(pushed, blockIdx.x, step, dt, body_count);
}

template <bool any_pushed>
__global__ void __launch_bounds__(block)
    find_pushes(const __grid_constant__ StepArguments g, const PushedBodies pushed, int step)
{
  const std::uint32_t p = blockIdx.x * block + threadIdx.x;
  physics::Vec3<float> force{ 0, 0, 0 };
  std::int32_t body = -1;
  if (p < g.contact.point_count)
  {
    const ContactPoint point = g.contact.points[p];
    const BoundPoints& bound = g.contact.bound;
    const physics::Vec3<float> moved =
        bound_displacement(bound.coordinates[p], bound.nodes[2 * p], bound.nodes[2 * p + 1], g.u[g.first]);
    force = find_push(g, point, { p, step, true, moved }).force;
    body = point.body;
    bound.pushes[p] = make_float4(force.x, force.y, force.z, 0);
  }
  if (any_pushed)
    put_reactions<block>(pushed, blockIdx.x, body, force);
}

}  // namespace cuda

std::uint32_t find_pushes_blocks(std::uint32_t points) { return (points + cuda::block - 1) / cuda::block; }

cudaError_t launch_find_pushes(const StepArguments& arguments, const PushedBodies& pushed, int step,
                               cudaStream_t stream)
{
  const ContactArguments& contact = arguments.contact;
  const auto blocks = find_pushes_blocks(contact.point_count);
  // Forces that are springs say nothing about the motion of bodies.
  const bool moves = pushed.count > 0 && !contact.spring;
  if (moves)
    cuda::move_bodies<<<pushed.count, cuda::warp, 0, stream>>>(pushed, step, arguments.dt_exact, contact.body_count);
  const auto kernel = moves ? cuda::find_pushes<true> : cuda::find_pushes<false>;
  kernel<<<blocks, cuda::block, 0, stream>>>(arguments, pushed, step);
  return cudaGetLastError();
}

}  // namespace frontalis
