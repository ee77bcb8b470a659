#pragma once

#include "frontalis/model/surface.hpp"

#include <vector>

namespace frontalis
{

/// Time and bone poses of one step, for restricted nodes.
struct ConstraintStep
{
  double time = 0;  ///< at the end of the step [s]
  double dt = 0;
  std::vector<RigidTransform> bone;         ///< at the end of the step
  std::vector<RigidTransform> bone_before;  ///< at its start
};

}  // namespace frontalis
