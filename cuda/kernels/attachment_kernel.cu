#include "cuda/kernels/attached_group.cuh"
#include "cuda/kernels/launch_after.cuh"

#include <algorithm>

namespace frontalis
{
namespace cuda
{

constexpr int block = 128;

__global__ void __launch_bounds__(block) follow_masters(const __grid_constant__ StepArguments g)
{
  let_next_kernel_start();
  wait_for_kernel_before();
  const std::uint32_t index = (blockIdx.x * block + threadIdx.x) / group_lanes;
  if (index >= g.attached.count)
    return;
  keep_planes<group_lanes>(g, group_tables(g.attached), index, g.u[1 - g.first], g.step_begin + 1);
  follow_master<group_lanes>(g, group_tables(g.attached), index, g.step_begin, g.u[1 - g.first], g.v);
}

__global__ void __launch_bounds__(block) take_masses(const float4* u, AttachedGroup* groups, std::uint32_t group_count,
                                                     AttachedTie* ties, std::uint32_t tie_count)
{
  const std::uint32_t i = blockIdx.x * block + threadIdx.x;
  if (i < group_count && u[groups[i].master].w > 0)
    groups[i].mass = 1 / u[groups[i].master].w;
  if (i < tie_count && u[ties[i].node].w > 0)
    ties[i].mass = 1 / u[ties[i].node].w;
}

}  // namespace cuda

cudaError_t launch_take_masses(const float4* u, AttachedGroup* groups, std::uint32_t group_count, AttachedTie* ties,
                               std::uint32_t tie_count, cudaStream_t stream)
{
  const std::uint32_t blocks = (std::max(group_count, tie_count) + cuda::block - 1) / cuda::block;
  cuda::take_masses<<<blocks, cuda::block, 0, stream>>>(u, groups, group_count, ties, tie_count);
  return cudaGetLastError();
}

cudaError_t launch_attached(const StepArguments& arguments, cudaStream_t stream)
{
  const std::uint32_t blocks = (arguments.attached.count * cuda::group_lanes + cuda::block - 1) / cuda::block;
  return cuda::launch_after(cuda::follow_masters, blocks, cuda::block, stream, arguments);
}

}  // namespace frontalis
