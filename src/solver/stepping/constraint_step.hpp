#pragma once

#include "frontalis/model/surface.hpp"

#include <vector>

namespace frontalis
{

/// What constraint_steps restricted nodes in one step.
struct ConstraintStep
{
  double time = 0;  ///< at the end of the step [s]
  double dt = 0;
  std::vector<RigidTransform> bone;         ///< at the end of the step
  std::vector<RigidTransform> bone_before;  ///< at its begin
};

}  // namespace frontalis
