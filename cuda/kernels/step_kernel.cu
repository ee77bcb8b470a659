#include "cuda/kernels/step_kernel.cuh"

namespace frontalis
{
namespace cuda
{
namespace
{

StepKernel kernel(Effects effects, bool with_bound)
{
  if ((effects & Effects::friction) == Effects::friction)
    return friction_step_kernel(effects, with_bound);
  if ((effects & Effects::sliding) == Effects::sliding)
    return sliding_step_kernel(effects, with_bound);
  return (effects & Effects::tasks) == Effects::tasks ? step_kernel_of<Effects::tasks>(effects, with_bound)
                                                      : step_kernel_of<Effects::none>(effects, with_bound);
}

}  // namespace
}  // namespace cuda

cudaError_t launch_steps(const StepArguments& arguments, const StepLaunch& launch, cudaStream_t stream)
{
  if (launch.patches)
    return launch_patches(arguments, launch, stream);
  const bool with_bound = arguments.frequency_bound != nullptr &&
                          (arguments.bound_every_step || arguments.step_begin + 1 == arguments.steps);
  cuda::kernel(launch.effects, with_bound)<<<launch.blocks, launch.threads, 0, stream>>>(arguments);
  return cudaGetLastError();
}

}  // namespace frontalis
