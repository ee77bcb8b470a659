#include "solver/cpu/shell_lanes.hpp"
#include "solver/cpu/touch_kernel_body.hpp"

namespace frontalis
{

TouchKernels<float> touch_kernels_avx2()
{
  using Body = TouchKernelBody<ShellLanes<xsimd::fma3<xsimd::avx2>>>;
  return { Body::place, Body::touch, Body::spread };
}

}  // namespace frontalis
