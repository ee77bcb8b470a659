#include "solver/cpu/attach_kernel_body.hpp"
#include "solver/cpu/slide_kernel_body.hpp"

namespace frontalis
{

SlideKernels<float> slide_kernels_avx512() { return SlideKernelBody<xsimd::avx512bw>::kernels(); }

void attach_kernel_avx512(const AttachArguments<float>& arguments, std::int32_t first, std::int32_t last)
{
  AttachKernelBody<xsimd::avx512bw, float>::run(arguments, first, last);
}

}  // namespace frontalis
