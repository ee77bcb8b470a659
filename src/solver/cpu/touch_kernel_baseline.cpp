#include "solver/cpu/record_lanes.hpp"
#include "solver/cpu/touch_kernel_body.hpp"

namespace frontalis
{

TouchKernels<float> touch_kernels_baseline() { return TouchKernelBody<RecordLanes<xsimd::default_arch>>::kernels(); }

}  // namespace frontalis
