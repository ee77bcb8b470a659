#pragma once

#include "cuda/kernels/step_kernel.hpp"
#include "frontalis/physics/number.hpp"

namespace frontalis
{
namespace cuda
{

// Poses of bones and bodies in single precision. They are stored as their difference from the identity, so that
// displacements are exact to nanometres and tissue that rests on a bone at rest does not move.

/// Pose of a body. Its inverse rotation is the identity + `less`. In the body's frame, a point at middle + arm + moved
/// has moved from its rest position by moved + shift + less * (arm + moved).
struct BodyPose
{
  physics::Vec3<float> less[3];  ///< rows
  physics::Vec3<float> shift;

  __device__ __forceinline__ physics::Vec3<float> gone(const physics::Vec3<float>& arm,
                                                       const physics::Vec3<float>& moved) const
  {
    const physics::Vec3<float> at = arm + moved;
    return moved + shift + less_of(at);
  }
  /// Turns a vector from the body's frame to the scene's.
  __device__ __forceinline__ physics::Vec3<float> turned(const physics::Vec3<float>& v) const
  {
    return v + v.x * less[0] + v.y * less[1] + v.z * less[2];
  }
  /// Vector from the present origin of the body's frame to the origin at rest.
  __device__ __forceinline__ physics::Vec3<float> back_to_rest(const physics::Vec3<double>& middle) const
  {
    const physics::Vec3<float> at{ static_cast<float>(middle.x + double(shift.x)),
                                   static_cast<float>(middle.y + double(shift.y)),
                                   static_cast<float>(middle.z + double(shift.z)) };
    return shift + at.x * less[0] + at.y * less[1] + at.z * less[2];
  }
  /// Turns a vector from the scene's frame to the body's.
  __device__ __forceinline__ physics::Vec3<float> turned_back(const physics::Vec3<float>& v) const
  {
    return v + less_of(v);
  }

protected:
  __device__ __forceinline__ physics::Vec3<float> less_of(const physics::Vec3<float>& v) const
  {
    return { dot(less[0], v), dot(less[1], v), dot(less[2], v) };
  }
};

/// Pose of a bone after a step, with the origin of the coordinates as `middle`, and its motion in the step: the point
/// of the bone at p in the bone's frame has the velocity spin * p + drift.
struct BoneMotion : BodyPose
{
  physics::Vec3<float> spin[3];  ///< rows [1/s]
  physics::Vec3<float> drift;    ///< [m/s]

  __device__ __forceinline__ physics::Vec3<float> velocity_at(const physics::Vec3<float>& place) const
  {
    return drift + physics::Vec3<float>{ dot(spin[0], place), dot(spin[1], place), dot(spin[2], place) };
  }
  /// Displacement of a point of the bone with this rest position [m].
  __device__ __forceinline__ physics::Vec3<float> displacement_of(const physics::Vec3<float>& rest) const
  {
    const physics::Vec3<float> at = rest - shift;
    return at.x * less[0] + at.y * less[1] + at.z * less[2] - shift;
  }
};

/// Reads three rows whose last entries are a vector of their own.
__device__ __forceinline__ void read_rows(const float4* from, physics::Vec3<float> (&rows)[3],
                                          physics::Vec3<float>& last)
{
  const float4 x = from[0], y = from[1], z = from[2];
  rows[0] = { x.x, x.y, x.z };
  rows[1] = { y.x, y.y, y.z };
  rows[2] = { z.x, z.y, z.z };
  last = { x.w, y.w, z.w };
}

/// Motion of a bone before the plan's first step (`when` = 0) or in its n-th step (`when` = n).
__device__ __forceinline__ BoneMotion bone_motion_at(const StepArguments& g, int when, std::int32_t bone)
{
  const float4* const from = g.bone_motions + 6 * (static_cast<std::size_t>(when) * g.bones + bone);
  BoneMotion motion;
  read_rows(from, motion.less, motion.shift);
  read_rows(from + 3, motion.spin, motion.drift);
  return motion;
}

}  // namespace cuda
}  // namespace frontalis
