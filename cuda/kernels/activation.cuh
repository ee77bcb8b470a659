#pragma once

#include "cuda/kernels/step_kernel.hpp"

namespace frontalis
{
namespace cuda
{

/// Fraction of a plan that has passed at the end of one of its steps.
__device__ __forceinline__ float fraction_passed(const StepArguments& g, std::int32_t step)
{
  return __fdiv_rn(static_cast<float>(step + 1), static_cast<float>(g.steps));
}

/// An activation at the start of a plan, and its change until the end.
__device__ __forceinline__ float2 activation_in_plan(const StepArguments& g, std::int32_t index)
{
  return make_float2(g.activation_begin[index], g.activation_end[index] - g.activation_begin[index]);
}

/// Activations in a step of a plan. They change linearly from the start of the plan to its end.
struct Activations
{
  const float2* of;  ///< one activation_in_plan() per muscle, in shared memory
  float fraction;    ///< see fraction_passed()

  __device__ __forceinline__ float operator[](std::uint32_t muscle) const
  {
    const float2 activation = of[muscle];
    return activation.x + fraction * activation.y;
  }
};

/// Loads activations into shared memory. All threads of a block must call this function once per launch.
__device__ __forceinline__ void load_activations(const StepArguments& g, float2* to)
{
  for (std::int32_t m = threadIdx.x; m < g.muscles; m += blockDim.x)
    to[m] = activation_in_plan(g, m);
}

__device__ __forceinline__ Activations activations_at(const StepArguments& g, std::int32_t step, const float2* of)
{
  return { of, fraction_passed(g, step) };
}

}  // namespace cuda
}  // namespace frontalis
