#pragma once

#include "frontalis/physics/pushed_body.hpp"

#include <vector_types.h>

#include <cstdint>

namespace frontalis
{

/// A body that forces push.
struct PushedBody
{
  physics::PushedBody<double> law;
  std::int32_t body;  ///< index into ContactArguments::bodies
};

/// The bodies that forces push, in device memory. Their motion is computed in double precision.
struct PushedBodies
{
  const PushedBody* bodies;
  std::uint32_t count;
  std::uint32_t blocks;  ///< number of blocks of the kernel that finds the forces on points
  /// In the steps of a plan: ContactArguments::poses, to which the motion of these bodies against their bones is added,
  /// and [step][pushed body] PushedMotion::held_at at the start of the step [m]
  float4* poses;
  const physics::Vec3<double>* held_at;
  // State:
  physics::PushedMotion<double>* motions;
  physics::Vec3<double>* reactions;  ///< [pushed body][block]: force of the tissue in the latest step [N]
};

}  // namespace frontalis
