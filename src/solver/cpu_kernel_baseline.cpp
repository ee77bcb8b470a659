#include "cpu_kernel_body.hpp"

namespace frontalis
{

float cpu_kernel_baseline(const CpuKernelArguments& arguments, std::int32_t first, std::int32_t last, float* buffer,
                          KernelTask task)
{
  return CpuKernelBody<xsimd::default_arch>::run(arguments, first, last, buffer, task);
}

}  // namespace frontalis
