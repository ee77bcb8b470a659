#include "solver/cpu/attach_kernel_body.hpp"
#include "solver/cpu/slide_kernel_body.hpp"

namespace frontalis
{

void slide_kernel_avx512(const SlideArguments<float>& arguments, std::int32_t first, std::int32_t last)
{
  SlideKernelBody<xsimd::avx512bw>::run(arguments, first, last);
}

void attach_kernel_avx512(const AttachArguments<float>& arguments, std::int32_t first, std::int32_t last)
{
  AttachKernelBody<xsimd::avx512bw, float>::run(arguments, first, last);
}

}  // namespace frontalis
