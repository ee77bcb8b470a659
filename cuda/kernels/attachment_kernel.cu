#include "cuda/kernels/attached_group.cuh"
#include "cuda/kernels/launch_after.cuh"

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

}  // namespace cuda

cudaError_t launch_attached(const StepArguments& arguments, cudaStream_t stream)
{
  const std::uint32_t blocks = (arguments.attached.count * cuda::group_lanes + cuda::block - 1) / cuda::block;
  return cuda::launch_after(cuda::follow_masters, blocks, cuda::block, stream, arguments);
}

}  // namespace frontalis
