#include "cuda/kernels/patch_kernel.cuh"

#include <mutex>

namespace frontalis
{
namespace cuda
{
namespace
{

const void* kernel(Effects effects)
{
  if ((effects & Effects::groups) == Effects::groups)
  {
    if ((effects & (Effects::shell | Effects::touch)) != Effects::none)
      return whole_group_patch_kernel(effects);
    return (effects & Effects::contact) == Effects::contact ? contact_group_patch_kernel(effects)
                                                            : group_patch_kernel(effects);
  }
  if ((effects & Effects::touch) == Effects::touch)
    return (effects & (Effects::contact | Effects::shell)) == Effects::none ? touch_patch_kernel(effects)
                                                                            : whole_patch_kernel(effects);
  if ((effects & Effects::shell) == Effects::shell)
    return (effects & Effects::contact) == Effects::none ? shell_patch_kernel(effects) : whole_patch_kernel(effects);
  if ((effects & Effects::contact) == Effects::contact)
    return contact_patch_kernel(effects);
  if ((effects & Effects::friction) == Effects::friction)
    return friction_patch_kernel(effects);
  if ((effects & Effects::sliding) == Effects::sliding)
    return sliding_patch_kernel(effects);
  return (effects & Effects::tasks) == Effects::tasks ? patch_kernel_of<Effects::tasks>(effects)
                                                      : patch_kernel_of<Effects::none>(effects);
}

}  // namespace
}  // namespace cuda

int resident_blocks(const StepLaunch& launch)
{
  int device = 0, processors = 0, blocks = 0;
  const void* const kernel = cuda::kernel(launch.effects);
  const auto bytes = static_cast<int>(launch.shared_bytes);
  cudaFuncAttributes known{};
  // The kernel's limit of shared memory is common to all solvers, which may be made at the same time. It is never
  // lowered, because another solver may need more.
  static std::mutex mutex;
  const std::lock_guard<std::mutex> lock(mutex);
  if (cudaGetDevice(&device) != cudaSuccess ||
      cudaDeviceGetAttribute(&processors, cudaDevAttrMultiProcessorCount, device) != cudaSuccess ||
      cudaFuncGetAttributes(&known, kernel) != cudaSuccess ||
      (known.maxDynamicSharedSizeBytes < bytes &&
       cudaFuncSetAttribute(kernel, cudaFuncAttributeMaxDynamicSharedMemorySize, bytes) != cudaSuccess) ||
      cudaOccupancyMaxActiveBlocksPerMultiprocessor(&blocks, kernel, launch.threads, launch.shared_bytes) !=
          cudaSuccess)
  {
    cudaGetLastError();  // or the next launch would report this error
    return 0;
  }
  return processors * blocks;
}

cudaError_t launch_patches(const StepArguments& arguments, const StepLaunch& launch, cudaStream_t stream)
{
  void* parameters[] = { const_cast<StepArguments*>(&arguments), const_cast<StepLaunch*>(&launch) };
  const void* const kernel = cuda::kernel(launch.effects);
  const dim3 grid(launch.blocks), block(launch.threads);
  // Patches that exchange data within a launch must run at the same time.
  if (arguments.step_end - arguments.step_begin > 1 || arguments.touch.in_patches.patches != nullptr)
    return cudaLaunchCooperativeKernel(kernel, grid, block, parameters, launch.shared_bytes, stream);
  return cudaLaunchKernel(kernel, grid, block, parameters, launch.shared_bytes, stream);
}

}  // namespace frontalis
