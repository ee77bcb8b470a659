#pragma once

#include "frontalis/model/surface.hpp"

#include <vector>

namespace frontalis
{

/// Times of one step, poses of the bones at its start and end, and activations.
struct ConstraintStep
{
  double time = 0;  ///< time at the end of the step [s]
  double dt = 0;
  double time_before = 0;                   ///< time at the start of the step [s]
  std::vector<RigidTransform> bone;         ///< poses at the end of the step
  std::vector<RigidTransform> bone_before;  ///< poses at the start of the step
  std::vector<float> activation;            ///< of each muscle during the step
  int index = 0;                            ///< in the plan of steps
};

}  // namespace frontalis
