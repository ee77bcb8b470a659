#pragma once

#include "frontalis/model/model.hpp"
#include "frontalis/physics/pose.hpp"

#include <algorithm>

namespace frontalis
{

inline physics::Pose pose_of(const RigidTransform& from)
{
  physics::Pose pose;
  std::copy(from.rotation.begin(), from.rotation.end(), pose.r);
  std::copy(from.translation.begin(), from.translation.end(), pose.t);
  return pose;
}

}  // namespace frontalis
