#include "cuda/kernels/contact_kernels.hpp"

#include "cuda/kernels/contact_points.cuh"
#include "cuda/kernels/launch_after.cuh"
#include "cuda/kernels/pushed_bodies.cuh"

namespace frontalis
{
namespace cuda
{

// In strips, contact has kernels of its own, which run before each step. Its forces change the velocities of nodes.

constexpr int block = contact_block, warp = 32;

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
  let_next_kernel_start();
  const std::uint32_t p = blockIdx.x * block + threadIdx.x;
  physics::Vec3<float> force{ 0, 0, 0 };
  std::int32_t body = -1;
  if (p < g.contact.point_count)
  {
    const ContactPoint point = g.contact.points[p];
    body = point.body;
    force = put_push(g, p, point, step, wait_for_kernel_before);
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
  return cuda::launch_after(kernel, blocks, cuda::block, stream, arguments, pushed, step);
}

}  // namespace frontalis
