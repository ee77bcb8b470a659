#pragma once

#include "solver/cpu/attach_kernel.hpp"
#include "solver/cpu/point_kernel.hpp"
#include "solver/cpu/shell_kernel.hpp"
#include "solver/cpu/slide_kernel.hpp"
#include "solver/cpu/touch_kernel.hpp"

namespace frontalis
{

/// Kernels of the effects on nodes, for one instruction set.
template <class Real>
struct PartKernels
{
  SlideKernels<Real> slide = plain_slide_kernels<Real>();
  AttachKernel<Real> attach = attach_plainly<Real>;
  ShellKernels<Real> shell = plain_shell_kernels<Real>();
  TouchKernels<Real> touch = plain_touch_kernels<Real>();
  PointKernel<Real> point = nullptr;  ///< null: points are processed one by one
};

}  // namespace frontalis
