#pragma once

#include "frontalis/model/surface.hpp"

#include <vector>

namespace frontalis
{

/// Time and bone poses of one step.
struct ConstraintStep
{
  double time = 0;  ///< at the end of the step [s]
  double dt = 0;
  double time_before = 0;                   ///< at its start [s]
  std::vector<RigidTransform> bone;         ///< at the end of the step
  std::vector<RigidTransform> bone_before;  ///< at its start
};

}  // namespace frontalis
