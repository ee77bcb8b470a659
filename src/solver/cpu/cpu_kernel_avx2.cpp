#include "solver/cpu/kernels_of.hpp"

namespace frontalis
{

CpuKernelChoice cpu_kernel_avx2(const char* name) { return kernels_of<xsimd::fma3<xsimd::avx2>>(name); }

}  // namespace frontalis
