#include "study/bench/bare_loop_body.hpp"

namespace frontalis
{

void bare_loop_baseline(const BareLoop& loop, int first, int last, float* scratch)
{
  BareLoopBody<xsimd::default_arch>::run(loop, first, last, scratch);
}

}  // namespace frontalis
