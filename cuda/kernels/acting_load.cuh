#pragma once

#include "frontalis/physics/ramp.hpp"
#include "cuda/kernels/activation.cuh"

namespace frontalis
{
namespace cuda
{

/// Fraction of a load that acts in a step of the plan.
__device__ __forceinline__ double acting_share(const StepArguments& g, std::int32_t load, std::int32_t step)
{
  const LoadGrowth growth = g.load_growth[load];
  if (growth.activation < 0)
    return physics::ramped(g.time + step * g.dt_exact, growth.ramp);
  const float2 activation = activation_in_plan(g, growth.activation);
  return activation.x + fraction_passed(g, step) * activation.y;
}

}  // namespace cuda
}  // namespace frontalis
