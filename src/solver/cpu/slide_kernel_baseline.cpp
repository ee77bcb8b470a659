#include "solver/cpu/attach_kernel_body.hpp"
#include "solver/cpu/slide_kernel_body.hpp"

namespace frontalis
{

SlideKernels<float> slide_kernels_baseline() { return SlideKernelBody<xsimd::default_arch>::kernels(); }

void attach_kernel_baseline(const AttachArguments<float>& arguments, std::int32_t first, std::int32_t last)
{
  AttachKernelBody<xsimd::default_arch, float>::run(arguments, first, last);
}

}  // namespace frontalis
