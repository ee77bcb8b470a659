#include "solver/cpu/one_lane.hpp"
#include "solver/cpu/touch_kernel_body.hpp"

namespace frontalis
{

template <class Real>
TouchKernels<Real> plain_touch_kernels()
{
  return TouchKernelBody<OneLane<Real>>::kernels();
}

template TouchKernels<float> plain_touch_kernels();
template TouchKernels<double> plain_touch_kernels();

}  // namespace frontalis
