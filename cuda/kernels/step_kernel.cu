#include "cuda/kernels/launch_after.cuh"
#include "cuda/kernels/strip_sweep.cuh"

#include <utility>

namespace frontalis
{
namespace cuda
{

// Each warp processes one strip. WithBound: whether stiffness bounds are computed. They take registers, and therefore
// have kernels of their own. Set: effects of voxels, as an int, because nvcc cannot name a combination of enumerators.
template <int Rows, bool WithBound, int Set>
__global__ void __launch_bounds__(step_block, strip_blocks(static_cast<Effects>(Set)))
    step_kernel(const __grid_constant__ StepArguments g)
{
  let_next_kernel_start();
  constexpr Effects With = static_cast<Effects>(Set);
  __shared__ float2 activations[has<With, Effects::fibres> ? most_muscles : 1];
  const std::uint32_t lane = threadIdx.x & 31;
  const std::uint32_t s = blockIdx.x * (step_block / 32) + threadIdx.x / 32;
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
  const std::uint32_t* words = nullptr;
  const std::uint32_t* viscous = nullptr;
  if (has<With, Effects::fibres> && strip.fibre_begin != Strip::none)
    words = g.fibre_words + strip.fibre_begin + lane;
  if (has<With, Effects::viscosity> && g.viscous_words != nullptr)
    viscous = g.viscous_words + strip.slot_begin + lane;
  std::uint32_t frequency_bits = 0;
  sweep_strip<Rows, With>(g, strip, g.slots + strip.slot_begin + lane, words, viscous, u, next,
                          activations_at(g, g.step_begin, activations), WithBound, frequency_bits);
  if (WithBound)
  {
    const std::uint32_t largest = largest_of_warp(frequency_bits);
    if (lane == 0)
      atomicMax(g.frequency_bound, largest);
  }
}

namespace
{

// Strips have kernels for all sets of viscosity, general elements and cut voxels, each without fibres, with fibres, and
// with added stress.
constexpr int whole_sets = 12, strip_sets = 2 * whole_sets;
constexpr int index_of(Effects effects)
{
  const bool fibres = (effects & Effects::fibres) != Effects::none, added = (effects & Effects::added) != Effects::none;
  const int whole = int(effects & (Effects::viscosity | Effects::general_element)) / 2 * 3 + (added    ? 2
                                                                                              : fibres ? 1
                                                                                                       : 0);
  return whole + ((effects & Effects::cut) == Effects::none ? 0 : whole_sets);
}
constexpr Effects set_of(int index)
{
  const Effects part[] = { Effects::none, Effects::fibres, Effects::added };
  const Effects whole = static_cast<Effects>(index % whole_sets / 3 * 2) | part[index % 3];
  return index < whole_sets ? whole : whole | Effects::cut;
}

template <bool WithBound, int... I>
auto step_kernel_of(Effects effects, std::integer_sequence<int, I...>)
{
  using Kernel = void (*)(StepArguments);
  const Kernel kernels[] = { step_kernel<strip_rows(set_of(I)), WithBound, int(set_of(I))>... };
  return kernels[index_of(effects)];
}

}  // namespace
}  // namespace cuda

cudaError_t launch_steps(const StepArguments& arguments, const StepLaunch& launch, cudaStream_t stream)
{
  if (launch.patches)
    return launch_patches(arguments, launch, stream);
  constexpr auto sets = std::make_integer_sequence<int, cuda::strip_sets>();
  const auto kernel = finds_bound(arguments) ? cuda::step_kernel_of<true>(launch.effects, sets)
                                             : cuda::step_kernel_of<false>(launch.effects, sets);
  cudaError_t status = cuda::launch_after(kernel, launch.blocks, launch.threads, stream, arguments);
  const bool tasks = (launch.effects & Effects::tasks) == Effects::tasks && !arguments.forces_only;
  if (status == cudaSuccess && tasks)
    status = launch_tasks(arguments, launch.effects, stream);
  return status == cudaSuccess && !arguments.forces_only ? launch_attached(arguments, stream) : status;
}

}  // namespace frontalis
