#pragma once

#include "cuda/kernels/bone_pose.cuh"
#include "cuda/kernels/pushed_bodies.hpp"

namespace frontalis
{
namespace cuda
{

// The motion of bodies that forces push. All sums have a fixed order, so that equal inputs give equal bits.

/// Sum over the lanes of a warp.
__device__ __forceinline__ physics::Vec3<double> sum_of_warp(physics::Vec3<double> sum)
{
#pragma unroll
  for (int apart = 16; apart > 0; apart /= 2)
    sum = sum + physics::Vec3<double>{ __shfl_xor_sync(0xffffffffu, sum.x, apart),
                                       __shfl_xor_sync(0xffffffffu, sum.y, apart),
                                       __shfl_xor_sync(0xffffffffu, sum.z, apart) };
  return sum;
}

/// Stores the reactions of the points of a block, each of which has one thread. `body`: the body that pushes the
/// thread's point with `force` [N]; -1: the thread has no point. All threads must call this function.
template <int most_threads>
__device__ __forceinline__ void put_reactions(const PushedBodies& pushed, std::uint32_t block, std::int32_t body,
                                              const physics::Vec3<float>& force)
{
  __shared__ physics::Vec3<double> of_warp[(most_threads + 31) / 32];
  for (std::uint32_t i = 0; i < pushed.count; ++i)
  {
    const bool pushes = body == pushed.bodies[i].body && (force.x != 0 || force.y != 0 || force.z != 0);
    physics::Vec3<double> sum{ 0, 0, 0 };
    if (pushes)
      sum = { -double(force.x), -double(force.y), -double(force.z) };
    // The barrier of this vote also ends the reading of the previous body's sums.
    const bool any = __syncthreads_or(pushes ? 1 : 0) != 0;
    if (any)
    {
      sum = sum_of_warp(sum);
      if (threadIdx.x % 32 == 0)
        of_warp[threadIdx.x / 32] = sum;
      __syncthreads();
    }
    if (threadIdx.x != 0)
      continue;
    for (std::uint32_t warp = 1; any && warp < (blockDim.x + 31) / 32; ++warp)
      sum = sum + of_warp[warp];
    pushed.reactions[i * pushed.blocks + block] = sum;
  }
}

/// Moves a pushed body on to the start of a step of length `dt` [s]. All lanes of a warp must call this function.
/// `body_count`: ContactArguments::body_count.
__device__ __forceinline__ void move_body(const PushedBodies& pushed, std::uint32_t i, int step, double dt,
                                          std::uint32_t body_count)
{
  physics::Vec3<double> reaction{ 0, 0, 0 };
  for (std::uint32_t block = threadIdx.x; block < pushed.blocks; block += blockDim.x)
    reaction = reaction + pushed.reactions[i * pushed.blocks + block];
  reaction = sum_of_warp(reaction);
  if (threadIdx.x != 0)
    return;
  const PushedBody& body = pushed.bodies[i];
  const physics::PushedMotion<double> before = pushed.motions[i];
  auto motion = moved_on(body.law, before, reaction, pushed.held_at[std::size_t(step) * pushed.count + i]);
  begin_step(motion, before.dt, dt);
  pushed.motions[i] = motion;
  const physics::Vec3<double> way = motion.centre - motion.held_at;
  float4* const rows = pushed.poses + 3 * (std::size_t(step) * body_count + body.body);
  BodyPose pose;
  read_rows(rows, pose.less, pose.shift);
  const physics::Vec3<float> shift =
      pose.turned_back({ static_cast<float>(way.x), static_cast<float>(way.y), static_cast<float>(way.z) });
  rows[0].w -= shift.x;
  rows[1].w -= shift.y;
  rows[2].w -= shift.z;
}

}  // namespace cuda
}  // namespace frontalis
