#if defined(__x86_64__)
#include "solver/cpu/record_lanes.hpp"
#include "solver/cpu/shell_kernel_body.hpp"
#else
#include "solver/cpu/shell_kernel.hpp"
#endif

namespace frontalis
{

ShellKernels<float> shell_kernels_baseline()
{
#if defined(__x86_64__)
  return ShellKernelBody<RecordLanes<xsimd::default_arch>>::all();
#else
  return plain_shell_kernels<float>();
#endif
}

}  // namespace frontalis
