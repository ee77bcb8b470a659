#include "solver/cpu/cpu_kernel_body.hpp"
#include "solver/cpu/cpu_monitor.hpp"

namespace frontalis
{

SlideKernels<float> slide_kernels_avx512();
ShellKernels<float> shell_kernels_avx512();
TouchKernels<float> touch_kernels_avx512();
void point_kernel_avx512(PointBlock<float>&, const float* const[3], const PosedBody<float>*, std::uint32_t,
                         PointPlaces<float>&);
void attach_kernel_avx512(const AttachArguments<float>&, std::int32_t, std::int32_t);

CpuKernelChoice cpu_kernel_avx512(const char* name)
{
  return { CpuKernelBody<xsimd::avx512bw, float>::run,
           CpuKernelBody<xsimd::avx512bw, double>::run,
           { slide_kernels_avx512(), attach_kernel_avx512, shell_kernels_avx512(), touch_kernels_avx512(),
             point_kernel_avx512 },
           CpuMonitor<xsimd::avx512bw>::run,
           name };
}

}  // namespace frontalis
