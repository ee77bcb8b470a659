#include "solver/cpu/shell_lanes.hpp"
#include "solver/cpu/touch_kernel_body.hpp"

namespace frontalis
{

TouchKernels<float> touch_kernels_avx512()
{
  using Body = TouchKernelBody<ShellLanes<xsimd::avx512bw>>;
  return { Body::place, Body::touch, Body::spread };
}

}  // namespace frontalis
