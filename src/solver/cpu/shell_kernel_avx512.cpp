#include "solver/cpu/shell_lanes.hpp"

namespace frontalis
{

ShellKernels<float> shell_kernels_avx512() { return ShellKernelBody<ShellLanes<xsimd::avx512bw>>::all(); }

}  // namespace frontalis
