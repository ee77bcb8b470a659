#include "solver/cpu/one_lane.hpp"
#include "solver/cpu/shell_kernel_body.hpp"

namespace frontalis
{

template <class Real>
ShellKernels<Real> plain_shell_kernels()
{
  return ShellKernelBody<OneLane<Real>>::all();
}

template ShellKernels<float> plain_shell_kernels();
template ShellKernels<double> plain_shell_kernels();

}  // namespace frontalis
