#include "cuda/kernels/step_kernel.cuh"

namespace frontalis
{
namespace cuda
{

StepKernel sliding_step_kernel(Effects effects, bool with_bound)
{
  return step_kernel_of<Effects::sliding | Effects::tasks>(effects, with_bound);
}

}  // namespace cuda
}  // namespace frontalis
