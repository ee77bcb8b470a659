#include "march.cuh"

#include <utility>

namespace frontalis
{
namespace cuda
{

// a warp a strip
// an int: nvcc does not name the sets of an enumeration
template <int Rows, int Set>
__global__ void __launch_bounds__(step_block, 3) step_kernel(const __grid_constant__ StepArguments g)
{
  constexpr Effects With = static_cast<Effects>(Set);
  __shared__ float activation[has<With, Effects::fibres> ? most_muscles : 1];
  const std::uint32_t lane = threadIdx.x & 31;
  const std::uint32_t s = blockIdx.x * (step_block / 32) + threadIdx.x / 32;
  const std::int32_t step = g.step_begin;
  const float4* const u = g.u[g.first];
  float4* const next = g.u[1 - g.first];
  const bool look = g.look != nullptr && (g.look_always || step + 1 == g.steps);
  if (has<With, Effects::fibres>)
  {
    set_activations(g, step, activation);
    __syncthreads();
  }
  if (s >= g.strip_count)
    return;
  const Strip strip = g.strips[s];
  const bool tasks = strip.task_begin < strip.task_end && !g.forces_only;
  const std::uint32_t first_task = strip.task_begin + lane;
  NodeTask task{};
  if (tasks && first_task < strip.task_end)
    task = g.tasks[first_task];
  const std::uint32_t* words = nullptr;
  const std::uint32_t* viscous = nullptr;
  if (has<With, Effects::fibres> && strip.fibre_begin != Strip::none)
    words = g.fibre_words + strip.fibre_begin + lane;
  if (has<With, Effects::viscosity> && g.viscous_words != nullptr)
    viscous = g.viscous_words + strip.slot_begin + lane;
  std::uint32_t frequency_bits = 0;
  march<Rows, With>(g, strip, g.slots + strip.slot_begin + lane, words, viscous, u, next, activation, look,
                    frequency_bits);
  if (tasks)
  {
    __syncwarp();
    if (first_task < strip.task_end)
      run_task(g, task, u, next, step);
    for (std::uint32_t t = first_task + 32; t < strip.task_end; t += 32)
      run_task(g, g.tasks[t], u, next, step);
  }
  if (look)
  {
    const std::uint32_t largest = __reduce_max_sync(whole_warp, frequency_bits);
    if (lane == 0)
      atomicMax(g.look, largest);
  }
}

using StepKernel = void (*)(StepArguments);

template <int... Sets>
StepKernel kernel(Effects effects, std::integer_sequence<int, Sets...>)
{
  const StepKernel kernels[] = { step_kernel<strip_rows(static_cast<Effects>(Sets)), Sets>... };
  return kernels[static_cast<int>(effects)];
}

}  // namespace cuda

cudaError_t launch_steps(const StepArguments& arguments, const StepLaunch& launch, cudaStream_t stream)
{
  if (launch.patches)
    return launch_patches(arguments, launch, stream);
  const auto kernel = cuda::kernel(launch.effects, std::make_integer_sequence<int, int(Effects::sliding)>());
  kernel<<<launch.blocks, launch.threads, 0, stream>>>(arguments);
  return cudaGetLastError();
}

}  // namespace frontalis
