#pragma once

#include "cuda/kernels/step_kernel.hpp"

namespace frontalis
{
namespace cuda
{

/// Of a bone: the scene's frame from the bone's.
struct Pose
{
  using Point = SurfaceContact::Point;

  double r[9], t[3];

  __device__ Point turned(const Point& p) const
  {
    return { r[0] * p.x + r[1] * p.y + r[2] * p.z, r[3] * p.x + r[4] * p.y + r[5] * p.z,
             r[6] * p.x + r[7] * p.y + r[8] * p.z };
  }
  __device__ Point turned_back(const Point& p) const
  {
    return { r[0] * p.x + r[3] * p.y + r[6] * p.z, r[1] * p.x + r[4] * p.y + r[7] * p.z,
             r[2] * p.x + r[5] * p.y + r[8] * p.z };
  }
  __device__ Point outwards(const Point& p) const { return turned(p) + Point{ t[0], t[1], t[2] }; }
  __device__ Point inwards(const Point& p) const { return turned_back(p - Point{ t[0], t[1], t[2] }); }
};

/// `when`: 0 before the plan's first step, n after its n-th.
__device__ __forceinline__ Pose pose_at(const StepArguments& g, int when, std::int32_t bone)
{
  const double* const from = g.poses + 12 * (static_cast<std::size_t>(when) * g.bones + bone);
  Pose pose{};
  for (int i = 0; i < 9; ++i)
    pose.r[i] = from[i];
  for (int i = 0; i < 3; ++i)
    pose.t[i] = from[9 + i];
  return pose;
}

}  // namespace cuda
}  // namespace frontalis
