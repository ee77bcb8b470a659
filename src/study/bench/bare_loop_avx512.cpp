#include "study/bench/bare_loop_body.hpp"

namespace frontalis
{

void bare_loop_avx512(const BareLoop& loop, int first, int last, float* scratch)
{
  BareLoopBody<xsimd::avx512bw>::run(loop, first, last, scratch);
}

}  // namespace frontalis
