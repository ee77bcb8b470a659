#if defined(__x86_64__)
#include "solver/cpu/shell_lanes.hpp"
#else
#include "solver/cpu/shell_kernel.hpp"
#endif

namespace frontalis
{

ShellKernels<float> shell_kernels_baseline()
{
#if defined(__x86_64__)
  return ShellKernelBody<ShellLanes<xsimd::default_arch>>::all();
#else
  return plain_shell_kernels<float>();
#endif
}

}  // namespace frontalis
