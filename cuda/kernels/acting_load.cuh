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
  // Equal to fraction_passed(). A function that kernels call through a table must not share its division in single
  // precision, because patches with fibres would spill registers: 7.5 instead of 5.4 us per step of the forehead at 1
  // mm.
  const auto passed = static_cast<float>((step + 1.0) / g.steps);
  return activation.x + passed * activation.y;
}

/// Force of surface loads on a loaded node in a step of the plan [N].
__device__ __forceinline__ void surface_load(const StepArguments& g, std::int32_t node, std::int32_t step,
                                             double (&force)[3])
{
  for (int i = 0; i < 3; ++i)
    force[i] = g.load_force == nullptr ? 0 : g.load_force[3 * node + i];
  const bool adds = g.load_begin != nullptr && g.load_force == nullptr;
  for (auto l = adds ? g.load_begin[node] : 0; adds && l < g.load_begin[node + 1]; ++l)
  {
    const LoadPart part = g.load_parts[l];
    const double share = part.weight * acting_share(g, part.load, step);
    for (int i = 0; i < 3; ++i)
      force[i] += share * g.surface_force[3 * part.force + i];
  }
}

}  // namespace cuda
}  // namespace frontalis
