#include "solver/cpu/slide_kernel_body.hpp"

namespace frontalis
{

void slide_kernel_avx512(const SlideArguments<float>& arguments, std::int32_t first, std::int32_t last)
{
  SlideKernelBody<xsimd::avx512bw>::run(arguments, first, last);
}

}  // namespace frontalis
