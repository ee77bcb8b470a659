#include "solver/cpu/shell_lanes.hpp"

namespace frontalis
{

ShellKernels<float> shell_kernels_avx2() { return ShellKernelBody<ShellLanes<xsimd::fma3<xsimd::avx2>>>::all(); }

}  // namespace frontalis
