#include "solver/cpu/cpu_kernel_body.hpp"
#include "solver/cpu/cpu_monitor.hpp"

namespace frontalis
{

SlideKernels<float> slide_kernels_baseline();
ShellKernels<float> shell_kernels_baseline();
TouchKernels<float> touch_kernels_baseline();
void point_kernel_baseline(PointBlock<float>&, const float* const[3], const PosedBody<float>*, std::uint32_t,
                           PointPlaces<float>&);
void attach_kernel_baseline(const AttachArguments<float>&, std::int32_t, std::int32_t);

CpuKernelChoice cpu_kernel_baseline(const char* name)
{
  return { CpuKernelBody<xsimd::default_arch, float>::run,
           CpuKernelBody<xsimd::default_arch, double>::run,
           { slide_kernels_baseline(), attach_kernel_baseline, shell_kernels_baseline(), touch_kernels_baseline(),
             point_kernel_baseline },
           CpuMonitor<xsimd::default_arch>::run,
           name };
}

}  // namespace frontalis
