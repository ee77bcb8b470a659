#include "march.cuh"
#include "node_tasks.cuh"

namespace frontalis
{
namespace cuda
{

// all blocks wait for each other; what they wrote before is seen after
__device__ __forceinline__ void grid_barrier(std::uint32_t* counter, std::uint32_t target)
{
  __syncthreads();
  if (threadIdx.x == 0)
  {
    __threadfence();
    asm volatile("red.release.gpu.global.add.u32 [%0], 1;" ::"l"(counter) : "memory");
    std::uint32_t seen;
    do
      asm volatile("ld.acquire.gpu.global.u32 %0, [%1];" : "=r"(seen) : "l"(counter) : "memory");
    while (static_cast<std::int32_t>(seen - target) < 0);
    __threadfence();
  }
  __syncthreads();
}

extern __shared__ uint2 cached_slots[];

// activations at the end of a step of the plan
__device__ __forceinline__ void set_activations(const StepArguments& g, std::int32_t step, float* activation)
{
  const auto fraction = static_cast<float>((step + 1.0) / g.steps);
  for (std::int32_t m = threadIdx.x; m < g.muscles; m += step_block)
  {
    const float begin = g.activation_begin[m];
    activation[m] = begin + fraction * (g.activation_end[m] - begin);
  }
}

template <int Rows, Effects With>
__global__ void __launch_bounds__(step_block, 3)
    step_kernel(const __grid_constant__ StepArguments g, std::uint32_t slots_a_warp)
{
  constexpr std::uint32_t warps_a_block = step_block / 32;
  __shared__ float activation[With != Effects::none ? most_muscles : 1];
  const std::uint32_t lane = threadIdx.x & 31;
  const std::uint32_t warp = blockIdx.x * warps_a_block + threadIdx.x / 32;
  // a warp that has one strip for all steps keeps its slots at hand
  uint2* const cache = slots_a_warp > 0 ? cached_slots + threadIdx.x / 32 * slots_a_warp : nullptr;
  Strip strip{};
  if (warp < g.strip_count)
    strip = g.strips[warp];
  if (cache != nullptr && warp < g.strip_count)
    for (std::uint32_t i = lane; i < (strip.planes + planes_ahead) * (Rows + 2) * 32; i += 32)
      cache[i] = g.slots[strip.slot_begin + i];
  auto* const cached_words = reinterpret_cast<std::uint32_t*>(cache + (strip.planes + planes_ahead) * (Rows + 2) * 32);
  if (With != Effects::none && cache != nullptr && warp < g.strip_count && strip.fibre_begin != Strip::none)
    for (std::uint32_t i = lane; i < strip.planes * (Rows + 1) * 32; i += 32)
      cached_words[i] = g.fibre_words[strip.fibre_begin + i];
  for (std::int32_t step = g.step_begin; step < g.step_end; ++step)
  {
    const int present = (g.first + step - g.step_begin) & 1;
    const float4* const u = g.u[present];
    float4* const next = g.u[1 - present];
    const bool look = g.look != nullptr && step + 1 == g.steps;
    if (With != Effects::none)
    {
      // the barrier between steps keeps the slower warps of a block from reading these too late
      set_activations(g, step, activation);
      __syncthreads();
    }
    std::uint32_t frequency_bits = 0;
    for (std::uint32_t s = warp; s < g.strip_count; s += gridDim.x * warps_a_block)
    {
      if (s != warp || s + gridDim.x * warps_a_block < g.strip_count)
        strip = g.strips[s];
      const bool tasks = strip.task_begin < strip.task_end && !g.forces_only;
      const std::uint32_t first_task = strip.task_begin + lane;
      NodeTask task{};
      if (tasks && first_task < strip.task_end)
        task = g.tasks[first_task];
      const uint2* const slots = cache != nullptr ? cache + lane : g.slots + strip.slot_begin + lane;
      const std::uint32_t* words = nullptr;
      if (With != Effects::none && strip.fibre_begin != Strip::none)
        words = cache != nullptr ? cached_words + lane : g.fibre_words + strip.fibre_begin + lane;
      march<Rows, With>(g, strip, slots, words, u, next, activation, look, frequency_bits);
      if (!tasks)
        continue;
      __syncwarp();
      if (first_task < strip.task_end)
        run_task(g, task, u, next, step);
      for (std::uint32_t t = first_task + 32; t < strip.task_end; t += 32)
        run_task(g, g.tasks[t], u, next, step);
      __syncwarp();
    }
    if (look)
    {
      const std::uint32_t largest = __reduce_max_sync(whole_warp, frequency_bits);
      if (lane == 0)
        atomicMax(g.look, largest);
    }
    if (step + 1 < g.step_end)
      grid_barrier(g.barrier, g.barrier_base + (step + 1 - g.step_begin) * gridDim.x);
  }
}

// nodes that would slide too far in the plan's steps at their present velocity get their closest points here, beside
// each other
__global__ void renew_contacts(const __grid_constant__ StepArguments g)
{
  const std::uint32_t index = blockIdx.x * 64 + threadIdx.x;
  if (index >= g.sliding_count)
    return;
  const std::uint32_t node = g.sliding[index].node;
  const float4 now = g.u[g.first][node];
  const float u[3] = { now.x, now.y, now.z };
  const float v[3] = { g.v[0][node], g.v[1][node], g.v[2][node] };
  const float4 reference = g.contact_planes[index].reference;
  const float ahead = g.steps * g.dt * sqrtf(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  constexpr auto allowed = static_cast<float>(0.8 * slip_until_renewal);
  if (reference.w != 0 || sqrtf(slip_squared(reference, u)) + ahead > allowed)
    renew_contact(g, static_cast<std::int32_t>(index), u, reference.w != 0);
}

namespace
{

template <int Rows>
const void* kernel(Effects effects)
{
  return effects == Effects::none ? reinterpret_cast<const void*>(step_kernel<Rows, Effects::none>)
                                  : reinterpret_cast<const void*>(step_kernel<Rows, Effects::fibres>);
}

const void* kernel(const StepLaunch& launch)
{
  if (launch.effects == Effects::all)
    return reinterpret_cast<const void*>(step_kernel<2, Effects::all>);
  return launch.rows == 1   ? kernel<1>(launch.effects)
         : launch.rows == 2 ? kernel<2>(launch.effects)
                            : kernel<4>(launch.effects);
}

std::size_t shared_bytes(const StepLaunch& launch) { return launch.slot_bytes * (step_block / 32); }

}  // namespace
}  // namespace cuda

int resident_blocks(const StepLaunch& launch)
{
  int device = 0, processors = 0, blocks = 0;
  const void* const kernel = cuda::kernel(launch);
  const std::size_t shared = cuda::shared_bytes(launch);
  if (cudaGetDevice(&device) != cudaSuccess ||
      cudaDeviceGetAttribute(&processors, cudaDevAttrMultiProcessorCount, device) != cudaSuccess ||
      cudaFuncSetAttribute(kernel, cudaFuncAttributeMaxDynamicSharedMemorySize,
                           static_cast<int>(most_slot_bytes * (step_block / 32))) != cudaSuccess ||
      cudaOccupancyMaxActiveBlocksPerMultiprocessor(&blocks, kernel, step_block, shared) != cudaSuccess)
    return 0;
  return processors * blocks;
}

cudaError_t launch_steps(const StepArguments& arguments, const StepLaunch& launch, cudaStream_t stream)
{
  auto slots = static_cast<std::uint32_t>(launch.slot_bytes / sizeof(uint2));
  void* parameters[] = { const_cast<StepArguments*>(&arguments), &slots };
  const void* const kernel = cuda::kernel(launch);
  const dim3 grid(launch.blocks), block(step_block);
  const std::size_t shared = cuda::shared_bytes(launch);
  if (arguments.step_end - arguments.step_begin > 1)
    return cudaLaunchCooperativeKernel(kernel, grid, block, parameters, shared, stream);
  return cudaLaunchKernel(kernel, grid, block, parameters, shared, stream);
}

cudaError_t launch_renewals(const StepArguments& arguments, cudaStream_t stream)
{
  if (arguments.sliding_count > 0)
    cuda::renew_contacts<<<(arguments.sliding_count + 63) / 64, 64, 0, stream>>>(arguments);
  return cudaGetLastError();
}

}  // namespace frontalis
