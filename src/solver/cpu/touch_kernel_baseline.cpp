#include "solver/cpu/point_kernel_body.hpp"
#include "solver/cpu/record_lanes.hpp"
#include "solver/cpu/touch_kernel_body.hpp"

namespace frontalis
{

TouchKernels<float> touch_kernels_baseline() { return TouchKernelBody<RecordLanes<xsimd::default_arch>>::kernels(); }

void point_kernel_baseline(PointBlock<float>& block, const float* const u[3], const PosedBody<float>* bodies,
                           std::uint32_t wanted, PointPlaces<float>& places)
{
  PointKernelBody<xsimd::default_arch>::run(block, u, bodies, wanted, places);
}

}  // namespace frontalis
