#include "solver/cpu/shell_lanes.hpp"

namespace frontalis
{

ShellKernels<float> shell_kernels_avx2()
{
  using Body = ShellKernelBody<ShellLanes<xsimd::fma3<xsimd::avx2>>>;
  return { Body::forces, Body::sum };
}

}  // namespace frontalis
