#include "solver/cpu/shell_lanes.hpp"

namespace frontalis
{

void shell_kernel_baseline(const ShellArguments<float>& arguments, std::int32_t first, std::int32_t last)
{
  ShellKernelBody<ShellLanes<xsimd::default_arch>>::run(arguments, first, last);
}

}  // namespace frontalis
