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

template <int Rows, bool Effects>
__global__ void __launch_bounds__(step_block) step_kernel(const __grid_constant__ StepArguments g)
{
  constexpr std::uint32_t warps_a_block = step_block / 32;
  const std::uint32_t warp = blockIdx.x * warps_a_block + threadIdx.x / 32;
  for (std::int32_t step = g.step_begin; step < g.step_end; ++step)
  {
    const int present = (g.first + step - g.step_begin) & 1;
    const float4* const u = g.u[present];
    float4* const next = g.u[1 - present];
    const bool look = g.look != nullptr && step + 1 == g.steps;
    const auto fraction = static_cast<float>((step + 1.0) / g.steps);
    std::uint32_t frequency_bits = 0;
    for (std::uint32_t s = warp; s < g.strip_count; s += gridDim.x * warps_a_block)
    {
      const Strip strip = g.strips[s];
      march<Rows, Effects>(g, strip, u, next, fraction, look, frequency_bits);
      if (strip.task_begin == strip.task_end || g.forces_only)
        continue;
      __syncwarp();
      for (std::uint32_t t = strip.task_begin + (threadIdx.x & 31); t < strip.task_end; t += 32)
        run_task(g, g.tasks[t], u, next, step);
      __syncwarp();
    }
    if (look)
    {
      const std::uint32_t largest = __reduce_max_sync(whole_warp, frequency_bits);
      if ((threadIdx.x & 31) == 0)
        atomicMax(g.look, largest);
    }
    if (step + 1 < g.step_end)
      grid_barrier(g.barrier, g.barrier_base + (step + 1 - g.step_begin) * gridDim.x);
  }
}

namespace
{

const void* kernel(int rows, bool effects)
{
  if (rows == strip_rows_small)
    return effects ? reinterpret_cast<const void*>(step_kernel<strip_rows_small, true>)
                   : reinterpret_cast<const void*>(step_kernel<strip_rows_small, false>);
  return effects ? reinterpret_cast<const void*>(step_kernel<strip_rows_large, true>)
                 : reinterpret_cast<const void*>(step_kernel<strip_rows_large, false>);
}

}  // namespace
}  // namespace cuda

int resident_blocks(int rows, bool effects)
{
  int device = 0, processors = 0, blocks = 0;
  if (cudaGetDevice(&device) != cudaSuccess ||
      cudaDeviceGetAttribute(&processors, cudaDevAttrMultiProcessorCount, device) != cudaSuccess ||
      cudaOccupancyMaxActiveBlocksPerMultiprocessor(&blocks, cuda::kernel(rows, effects), step_block, 0) != cudaSuccess)
    return 0;
  return processors * blocks;
}

cudaError_t launch_steps(const StepArguments& arguments, int rows, bool effects, int blocks, cudaStream_t stream)
{
  void* parameters[] = { const_cast<StepArguments*>(&arguments) };
  const void* const kernel = cuda::kernel(rows, effects);
  if (arguments.step_end - arguments.step_begin > 1)
    return cudaLaunchCooperativeKernel(kernel, dim3(blocks), dim3(step_block), parameters, 0, stream);
  return cudaLaunchKernel(kernel, dim3(blocks), dim3(step_block), parameters, 0, stream);
}

}  // namespace frontalis
