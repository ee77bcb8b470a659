#include "solver/cpu/record_lanes.hpp"
#include "solver/cpu/shell_kernel_body.hpp"

namespace frontalis
{

ShellKernels<float> shell_kernels_avx2() { return ShellKernelBody<RecordLanes<xsimd::fma3<xsimd::avx2>>>::all(); }

}  // namespace frontalis
