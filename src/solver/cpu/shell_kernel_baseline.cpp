#include "solver/cpu/shell_lanes.hpp"

namespace frontalis
{

ShellKernels<float> shell_kernels_baseline()
{
  using Body = ShellKernelBody<ShellLanes<xsimd::default_arch>>;
  return { Body::forces, Body::sum };
}

}  // namespace frontalis
