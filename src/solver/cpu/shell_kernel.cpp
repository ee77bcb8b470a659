#include "solver/cpu/shell_kernel_body.hpp"

namespace frontalis
{
namespace
{

template <class Number>
struct OneLane
{
  using Real = Number;
  using Batch = Number;
  static constexpr int count = 1;

  static FRONTALIS_LAW Number load(const Number* p) { return *p; }
  static FRONTALIS_LAW Number gather(const Number* p, const std::int32_t* index) { return p[*index]; }
  static FRONTALIS_LAW void store(Number x, Number* p) { *p = x; }
};

}  // namespace

template <class Real>
void shell_plainly(const ShellArguments<Real>& arguments, std::int32_t first, std::int32_t last)
{
  ShellKernelBody<OneLane<Real>>::run(arguments, first, last);
}

template void shell_plainly(const ShellArguments<float>&, std::int32_t, std::int32_t);
template void shell_plainly(const ShellArguments<double>&, std::int32_t, std::int32_t);

}  // namespace frontalis
