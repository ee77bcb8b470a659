#pragma once

#include "cuda/kernels/kernel_before.cuh"

#include <cuda_runtime.h>

#include <cstdint>

namespace frontalis
{
namespace cuda
{

/// Launches a kernel all of whose threads that write anything have called wait_for_kernel_before(). Without blocks it
/// does nothing.
template <class... Parameters, class... Arguments>
cudaError_t launch_after(void (*kernel)(Parameters...), std::uint32_t blocks, std::uint32_t threads,
                         cudaStream_t stream, const Arguments&... arguments)
{
  if (blocks == 0)
    return cudaSuccess;
  // The same for all kernels with these parameters, because a build has the same architectures for all.
  static const bool early = [kernel]
  {
    cudaFuncAttributes attributes{};
    return cudaFuncGetAttributes(&attributes, kernel) == cudaSuccess && attributes.ptxVersion >= 90;
  }();
  cudaLaunchAttribute attribute{};
  attribute.id = cudaLaunchAttributeProgrammaticStreamSerialization;
  attribute.val.programmaticStreamSerializationAllowed = 1;
  cudaLaunchConfig_t config{};
  config.gridDim = blocks;
  config.blockDim = threads;
  config.stream = stream;
  config.attrs = &attribute;
  config.numAttrs = early ? 1 : 0;
  return cudaLaunchKernelEx(&config, kernel, arguments...);
}

}  // namespace cuda
}  // namespace frontalis
