#include "cuda/kernels/attached_group.cuh"

namespace frontalis
{
namespace cuda
{

constexpr int block = 64;  // few threads, because the groups of most models do not fill the device

__global__ void __launch_bounds__(block)
    follow_masters(const __grid_constant__ StepArguments g, const __grid_constant__ AttachedArguments attached)
{
  const std::uint32_t index = blockIdx.x * block + threadIdx.x;
  if (index < attached.count)
    follow_master(g, attached, index);
}

}  // namespace cuda

cudaError_t launch_attached(const StepArguments& arguments, const AttachedArguments& attached, cudaStream_t stream)
{
  const std::uint32_t blocks = (attached.count + cuda::block - 1) / cuda::block;
  cuda::follow_masters<<<blocks, cuda::block, 0, stream>>>(arguments, attached);
  return cudaGetLastError();
}

}  // namespace frontalis
