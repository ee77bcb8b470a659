#include "solver/cpu/slide_kernel_body.hpp"

namespace frontalis
{

void slide_kernel_avx2(const SlideArguments<float>& arguments, std::int32_t first, std::int32_t last)
{
  SlideKernelBody<xsimd::fma3<xsimd::avx2>>::run(arguments, first, last);
}

}  // namespace frontalis
