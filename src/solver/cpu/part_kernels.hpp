#pragma once

#include "solver/cpu/attach_kernel.hpp"
#include "solver/cpu/shell_kernel.hpp"
#include "solver/cpu/slide_kernel.hpp"
#include "solver/cpu/touch_kernel.hpp"

namespace frontalis
{

/// Kernels of the effects on nodes, for one instruction set.
template <class Real>
struct PartKernels
{
  SlideKernel<Real> slide = slide_plainly<Real>;
  AttachKernel<Real> attach = attach_plainly<Real>;
  ShellKernels<Real> shell = plain_shell_kernels<Real>();
  TouchKernels<Real> touch = plain_touch_kernels<Real>();
};

}  // namespace frontalis
