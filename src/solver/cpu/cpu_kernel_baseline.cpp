#include "solver/cpu/kernels_of.hpp"

namespace frontalis
{

CpuKernelChoice cpu_kernel_baseline(const char* name) { return kernels_of<xsimd::default_arch>(name); }

}  // namespace frontalis
