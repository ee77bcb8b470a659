#pragma once

#include "frontalis/physics/ramp.hpp"
#include "cuda/kernels/step_kernel.hpp"

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
  const float begin = g.activation_begin[growth.activation];
  return begin + __fdiv_rn(static_cast<float>(step + 1), static_cast<float>(g.steps)) *
                     (g.activation_end[growth.activation] - begin);
}

}  // namespace cuda
}  // namespace frontalis
