#include "solver/cpu/shell_lanes.hpp"

namespace frontalis
{

void shell_kernel_avx512(const ShellArguments<float>& arguments, std::int32_t first, std::int32_t last)
{
  ShellKernelBody<ShellLanes<xsimd::avx512bw>>::run(arguments, first, last);
}

}  // namespace frontalis
