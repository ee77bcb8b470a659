#include "solver/cpu/shell_lanes.hpp"
#include "solver/cpu/touch_kernel_body.hpp"

namespace frontalis
{

TouchKernels<float> touch_kernels_baseline()
{
  using Body = TouchKernelBody<ShellLanes<xsimd::default_arch>>;
  return { Body::place, Body::touch, Body::spread };
}

}  // namespace frontalis
