#include "solver/cpu/attach_kernel_body.hpp"
#include "solver/cpu/slide_kernel_body.hpp"

namespace frontalis
{

void slide_kernel_baseline(const SlideArguments<float>& arguments, std::int32_t first, std::int32_t last)
{
  SlideKernelBody<xsimd::default_arch>::run(arguments, first, last);
}

void attach_kernel_baseline(const AttachArguments<float>& arguments, std::int32_t first, std::int32_t last)
{
  AttachKernelBody<xsimd::default_arch, float>::run(arguments, first, last);
}

}  // namespace frontalis
