#include "cuda/kernels/step_kernel.cuh"

namespace frontalis
{
namespace cuda
{

StepKernel sliding_step_kernel(Effects effects, bool look)
{
  return step_kernel_of<Effects::sliding | Effects::tasks>(effects, look);
}

}  // namespace cuda
}  // namespace frontalis
