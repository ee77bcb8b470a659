#include "solver/cpu/shell_lanes.hpp"

namespace frontalis
{

ShellKernels<float> shell_kernels_baseline() { return ShellKernelBody<ShellLanes<xsimd::default_arch>>::all(); }

}  // namespace frontalis
