#include "cpu_kernel_body.hpp"

namespace frontalis
{

float cpu_kernel_avx512(const CpuKernelArguments& arguments, std::int32_t first, std::int32_t last, float* buffer,
                        KernelTask task)
{
  return CpuKernelBody<xsimd::avx512bw>::run(arguments, first, last, buffer, task);
}

}  // namespace frontalis
