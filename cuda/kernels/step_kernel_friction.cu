#include "cuda/kernels/step_kernel.cuh"

namespace frontalis
{
namespace cuda
{

StepKernel friction_step_kernel(Effects effects, bool look) { return step_kernel_of<of_nodes>(effects, look); }

}  // namespace cuda
}  // namespace frontalis
