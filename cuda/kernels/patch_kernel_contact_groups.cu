#include "cuda/kernels/patch_kernel.cuh"

namespace frontalis
{
namespace cuda
{

const void* contact_group_patch_kernel(Effects effects)
{
  return patch_kernel_of<of_nodes | Effects::contact | Effects::cut | Effects::groups>(effects);
}

}  // namespace cuda
}  // namespace frontalis
