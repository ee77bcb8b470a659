#include "cuda/kernels/step_kernel.cuh"

namespace frontalis
{
namespace cuda
{
namespace
{

StepKernel kernel(Effects effects, bool look)
{
  if ((effects & Effects::friction) == Effects::friction)
    return friction_step_kernel(effects, look);
  if ((effects & Effects::sliding) == Effects::sliding)
    return sliding_step_kernel(effects, look);
  return (effects & Effects::tasks) == Effects::tasks ? step_kernel_of<Effects::tasks>(effects, look)
                                                      : step_kernel_of<Effects::none>(effects, look);
}

}  // namespace
}  // namespace cuda

cudaError_t launch_steps(const StepArguments& arguments, const StepLaunch& launch, cudaStream_t stream)
{
  if (launch.patches)
    return launch_patches(arguments, launch, stream);
  const bool look = arguments.look != nullptr && (arguments.look_always || arguments.step_begin + 1 == arguments.steps);
  cuda::kernel(launch.effects, look)<<<launch.blocks, launch.threads, 0, stream>>>(arguments);
  return cudaGetLastError();
}

}  // namespace frontalis
