#include "solver/cpu/cpu_kernel_body.hpp"
#include "solver/cpu/cpu_monitor.hpp"

namespace frontalis
{

SlideKernels<float> slide_kernels_avx2();
ShellKernels<float> shell_kernels_avx2();
TouchKernels<float> touch_kernels_avx2();
void point_kernel_avx2(PointBlock<float>&, const float* const[3], const PosedBody<float>*, std::uint32_t,
                       PointPlaces<float>&);
void attach_kernel_avx2(const AttachArguments<float>&, std::int32_t, std::int32_t);

CpuKernelChoice cpu_kernel_avx2(const char* name)
{
  return { CpuKernelBody<xsimd::fma3<xsimd::avx2>, float>::run,
           CpuKernelBody<xsimd::fma3<xsimd::avx2>, double>::run,
           { slide_kernels_avx2(), attach_kernel_avx2, shell_kernels_avx2(), touch_kernels_avx2(), point_kernel_avx2 },
           CpuMonitor<xsimd::fma3<xsimd::avx2>>::run,
           name };
}

}  // namespace frontalis
