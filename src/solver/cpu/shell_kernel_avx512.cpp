#include "solver/cpu/shell_lanes.hpp"

namespace frontalis
{

ShellKernels<float> shell_kernels_avx512()
{
  using Body = ShellKernelBody<ShellLanes<xsimd::avx512bw>>;
  return { Body::forces, Body::sum };
}

}  // namespace frontalis
