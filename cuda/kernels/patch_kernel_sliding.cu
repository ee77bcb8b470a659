#include "cuda/kernels/patch_kernel.cuh"

namespace frontalis
{
namespace cuda
{

const void* sliding_patch_kernel(Effects effects)
{
  return patch_kernel_of<Effects::sliding | Effects::tasks>(effects);
}

}  // namespace cuda
}  // namespace frontalis
