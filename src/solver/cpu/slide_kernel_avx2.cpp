#include "solver/cpu/attach_kernel_body.hpp"
#include "solver/cpu/slide_kernel_body.hpp"

namespace frontalis
{

SlideKernels<float> slide_kernels_avx2() { return SlideKernelBody<xsimd::fma3<xsimd::avx2>>::kernels(); }

void attach_kernel_avx2(const AttachArguments<float>& arguments, std::int32_t first, std::int32_t last)
{
  AttachKernelBody<xsimd::fma3<xsimd::avx2>, float>::run(arguments, first, last);
}

}  // namespace frontalis
