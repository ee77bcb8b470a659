#include "solver/cpu/record_lanes.hpp"
#include "solver/cpu/shell_kernel_body.hpp"

namespace frontalis
{

ShellKernels<float> shell_kernels_avx512() { return ShellKernelBody<RecordLanes<xsimd::avx512bw>>::all(); }

}  // namespace frontalis
