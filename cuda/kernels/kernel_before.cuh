#pragma once

#include <cuda_runtime.h>

namespace frontalis
{
namespace cuda
{

// A kernel that launch_after() launches may start before the kernel before it has ended. Until it has called
// wait_for_kernel_before(), it only reads data that no kernel of a step writes. It calls let_next_kernel_start() first,
// so that the next kernel loads such data while this one runs.

/// Waits for the end of the preceding kernel, and with it of all kernels before. Code for compute capabilities
/// below 9.0 cannot wait, and is never launched early.
__device__ __forceinline__ void wait_for_kernel_before()
{
#if __CUDA_ARCH__ >= 900
  cudaGridDependencySynchronize();
#endif
}

/// Allows the next kernel to be launched.
__device__ __forceinline__ void let_next_kernel_start()
{
#if __CUDA_ARCH__ >= 900
  cudaTriggerProgrammaticLaunchCompletion();
#endif
}

}  // namespace cuda
}  // namespace frontalis
