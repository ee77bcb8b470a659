#include "cuda/kernels/step_kernel.cuh"

namespace frontalis
{
namespace cuda
{

StepKernel friction_step_kernel(Effects effects, bool with_bound)
{
  return step_kernel_of<of_nodes>(effects, with_bound);
}

}  // namespace cuda
}  // namespace frontalis
