#include "solver/cpu/record_lanes.hpp"
#include "solver/cpu/touch_kernel_body.hpp"

namespace frontalis
{

TouchKernels<float> touch_kernels_avx512() { return TouchKernelBody<RecordLanes<xsimd::avx512bw>>::kernels(); }

}  // namespace frontalis
