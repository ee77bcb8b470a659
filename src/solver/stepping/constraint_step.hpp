#pragma once

#include "frontalis/model/surface.hpp"

#include <vector>

namespace frontalis
{

/// Time and bone poses of one step.
struct ConstraintStep
{
  double time = 0;  ///< time at the end of the step [s]
  double dt = 0;
  double time_before = 0;                   ///< time at the start of the step [s]
  std::vector<RigidTransform> bone;         ///< poses at the end of the step
  std::vector<RigidTransform> bone_before;  ///< poses at the start of the step
};

}  // namespace frontalis
