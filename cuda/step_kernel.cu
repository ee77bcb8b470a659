#include "march.cuh"

namespace frontalis
{
namespace cuda
{

// a warp a strip
template <int Rows, Effects With>
__global__ void __launch_bounds__(step_block, 3) step_kernel(const __grid_constant__ StepArguments g)
{
  __shared__ float activation[With != Effects::none ? most_muscles : 1];
  const std::uint32_t lane = threadIdx.x & 31;
  const std::uint32_t s = blockIdx.x * (step_block / 32) + threadIdx.x / 32;
  const std::int32_t step = g.step_begin;
  const float4* const u = g.u[g.first];
  float4* const next = g.u[1 - g.first];
  const bool look = g.look != nullptr && step + 1 == g.steps;
  if (With != Effects::none)
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
  if (With != Effects::none && strip.fibre_begin != Strip::none)
    words = g.fibre_words + strip.fibre_begin + lane;
  if (With == Effects::all && g.viscous_words != nullptr)
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

}  // namespace cuda

cudaError_t launch_steps(const StepArguments& arguments, const StepLaunch& launch, cudaStream_t stream)
{
  if (launch.patches)
    return launch_patches(arguments, launch, stream);
  const auto kernel = launch.effects == Effects::none ? cuda::step_kernel<strip_rows(Effects::none), Effects::none>
                      : launch.effects == Effects::fibres
                          ? cuda::step_kernel<strip_rows(Effects::fibres), Effects::fibres>
                          : cuda::step_kernel<strip_rows(Effects::all), Effects::all>;
  kernel<<<launch.blocks, launch.threads, 0, stream>>>(arguments);
  return cudaGetLastError();
}

}  // namespace frontalis
