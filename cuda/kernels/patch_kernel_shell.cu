#include "cuda/kernels/patch_kernel.cuh"

namespace frontalis
{
namespace cuda
{

const void* shell_patch_kernel(Effects effects) { return patch_kernel_of<of_nodes | Effects::shell>(effects); }

}  // namespace cuda
}  // namespace frontalis
