#include "study/bench/bare_loop_body.hpp"

namespace frontalis
{

void bare_loop_avx2(const BareLoop& loop, int first, int last, float* scratch)
{
  BareLoopBody<xsimd::fma3<xsimd::avx2>>::run(loop, first, last, scratch);
}

}  // namespace frontalis
