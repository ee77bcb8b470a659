#pragma once

#include "cuda/kernels/step_kernel.hpp"
#include "frontalis/physics/pose.hpp"

namespace frontalis
{
namespace cuda
{

using physics::Pose;

/// Pose of a bone before the plan's first step (`when` = 0) or after its n-th step (`when` = n).
__device__ __forceinline__ Pose pose_at(const StepArguments& g, int when, std::int32_t bone)
{
  const double* const from = g.poses + 12 * (static_cast<std::size_t>(when) * g.bones + bone);
  Pose pose;
  for (int i = 0; i < 9; ++i)
    pose.r[i] = from[i];
  for (int i = 0; i < 3; ++i)
    pose.t[i] = from[9 + i];
  return pose;
}

}  // namespace cuda
}  // namespace frontalis
