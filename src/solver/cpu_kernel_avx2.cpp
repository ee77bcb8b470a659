#include "cpu_kernel_body.hpp"

namespace frontalis
{

float cpu_kernel_avx2(const CpuKernelArguments& arguments, std::int32_t first, std::int32_t last, float* buffer,
                      KernelTask task)
{
  return CpuKernelBody<xsimd::fma3<xsimd::avx2>>::run(arguments, first, last, buffer, task);
}

}  // namespace frontalis
