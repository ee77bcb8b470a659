#pragma once

#include "solver/cpu/attach_kernel_body.hpp"
#include "solver/cpu/cpu_kernel_body.hpp"
#include "solver/cpu/cpu_monitor.hpp"
#include "solver/cpu/point_kernel_body.hpp"
#include "solver/cpu/record_lanes.hpp"
#include "solver/cpu/shell_kernel_body.hpp"
#include "solver/cpu/slide_kernel_body.hpp"
#include "solver/cpu/touch_kernel_body.hpp"

namespace frontalis
{

/// All kernels for an instruction set. Only the files cpu_kernel_*.cpp may include this one: each is compiled for its
/// instruction set.
template <class Arch>
CpuKernelChoice kernels_of(const char* name)
{
  using Records = RecordLanes<Arch>;
  return { CpuKernelBody<Arch, float>::run,
           CpuKernelBody<Arch, double>::run,
           { SlideKernelBody<Arch>::kernels(), AttachKernelBody<Arch, float>::run, ShellKernelBody<Records>::all(),
             TouchKernelBody<Records>::kernels(), PointKernelBody<Arch>::run },
           CpuMonitor<Arch>::run,
           name };
}

}  // namespace frontalis
