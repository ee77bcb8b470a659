#pragma once

#include "cuda/kernels/strip_sweep.cuh"

#include <utility>

namespace frontalis
{
namespace cuda
{

// Each warp processes one strip. WithBound: whether stiffness bounds are computed. They take registers, and therefore
// have kernels of their own. Set is an int, because nvcc cannot name a combination of enumerators.
template <int Rows, bool WithBound, int Set>
__global__ void __launch_bounds__(step_block, strip_blocks(static_cast<Effects>(Set)))
    step_kernel(const __grid_constant__ StepArguments g)
{
  constexpr Effects With = static_cast<Effects>(Set);
  __shared__ float2 activations[has<With, Effects::fibres> ? most_muscles : 1];
  const std::uint32_t lane = threadIdx.x & 31;
  const std::uint32_t s = blockIdx.x * (step_block / 32) + threadIdx.x / 32;
  const std::int32_t step = g.step_begin;
  const float4* const u = g.u[g.first];
  float4* const next = g.u[1 - g.first];
  if (has<With, Effects::fibres>)
  {
    load_activations(g, activations);
    __syncthreads();
  }
  if (s >= g.strip_count)
    return;
  const Strip strip = g.strips[s];
  const bool tasks = has<With, Effects::tasks> && strip.task_begin < strip.task_end && !g.forces_only;
  const std::uint32_t* words = nullptr;
  const std::uint32_t* viscous = nullptr;
  if (has<With, Effects::fibres> && strip.fibre_begin != Strip::none)
    words = g.fibre_words + strip.fibre_begin + lane;
  if (has<With, Effects::viscosity> && g.viscous_words != nullptr)
    viscous = g.viscous_words + strip.slot_begin + lane;
  std::uint32_t frequency_bits = 0;
  sweep_strip<Rows, With>(g, strip, g.slots + strip.slot_begin + lane, words, viscous, u, next,
                          activations_at(g, step, activations), WithBound, frequency_bits);
  if (tasks)
  {
    __syncwarp();
    run_tasks<part<With, of_nodes>>(g, strip.task_begin, strip.task_end, u, next, step);
  }
  if (WithBound)
  {
    const std::uint32_t largest = largest_of_warp(frequency_bits);
    if (lane == 0)
      atomicMax(g.frequency_bound, largest);
  }
}

using StepKernel = void (*)(StepArguments);

/// The strip kernel with the effects of voxels in `effects` and the effects of nodes in `Nodes`.
template <Effects Nodes, bool WithBound, int... Voxels>
StepKernel step_kernel_of(Effects effects, std::integer_sequence<int, Voxels...>)
{
  const StepKernel kernels[] = {
    step_kernel<strip_rows(static_cast<Effects>(Voxels)), WithBound, Voxels | int(Nodes)>...
  };
  return kernels[static_cast<int>(voxel_part(effects))];
}
template <Effects Nodes>
StepKernel step_kernel_of(Effects effects, bool with_bound)
{
  using Sets = std::make_integer_sequence<int, voxel_sets>;
  return with_bound ? step_kernel_of<Nodes, true>(effects, Sets()) : step_kernel_of<Nodes, false>(effects, Sets());
}

/// Kernels are in separate translation units for the reason given in patch_kernel.cuh.
StepKernel sliding_step_kernel(Effects effects, bool with_bound);
StepKernel friction_step_kernel(Effects effects, bool with_bound);

}  // namespace cuda
}  // namespace frontalis
