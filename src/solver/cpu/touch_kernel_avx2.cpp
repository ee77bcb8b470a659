#include "solver/cpu/point_kernel_body.hpp"
#include "solver/cpu/record_lanes.hpp"
#include "solver/cpu/touch_kernel_body.hpp"

namespace frontalis
{

TouchKernels<float> touch_kernels_avx2() { return TouchKernelBody<RecordLanes<xsimd::fma3<xsimd::avx2>>>::kernels(); }

void point_kernel_avx2(PointBlock<float>& block, const float* const u[3], const PosedBody<float>* bodies,
                       std::uint32_t wanted, PointPlaces<float>& places)
{
  PointKernelBody<xsimd::fma3<xsimd::avx2>>::run(block, u, bodies, wanted, places);
}

}  // namespace frontalis
