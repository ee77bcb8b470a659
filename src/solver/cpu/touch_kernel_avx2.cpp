#include "solver/cpu/record_lanes.hpp"
#include "solver/cpu/touch_kernel_body.hpp"

namespace frontalis
{

TouchKernels<float> touch_kernels_avx2() { return TouchKernelBody<RecordLanes<xsimd::fma3<xsimd::avx2>>>::kernels(); }

}  // namespace frontalis
