#include "solver/cpu/kernels_of.hpp"

namespace frontalis
{

CpuKernelChoice cpu_kernel_avx512(const char* name) { return kernels_of<xsimd::avx512bw>(name); }

}  // namespace frontalis
