#include "solver/cpu/shell_lanes.hpp"

namespace frontalis
{

void shell_kernel_avx2(const ShellArguments<float>& arguments, std::int32_t first, std::int32_t last)
{
  ShellKernelBody<ShellLanes<xsimd::fma3<xsimd::avx2>>>::run(arguments, first, last);
}

}  // namespace frontalis
