#pragma once

#include <cstdint>

namespace frontalis
{

/// Up to `width` triangles of a shell: physics::ShellTriangle and the numbers of its vertices, one triangle per lane.
/// Lanes beyond the last triangle have no stiffness.
template <class Real>
struct ShellBlock
{
  static constexpr int width = 16;

  Real from_corner[5][3][width];
  Real metric[3][width];
  Real area_twice[width], shear[width], dilatation[width];
  Real height[3][width], bending[6][width];
  std::int32_t vertex[6][width];
};

/// The forces of blocks [first, last) at the displacements u of vertices. Plain pointers, as for CpuKernel.
template <class Real>
struct ShellArguments
{
  const ShellBlock<Real>* blocks;
  const Real* u[3];
  Real* forces;  ///< [block][vertex of the triangle][axis][lane] [N]
};
template <class Real>
using ShellKernel = void (*)(const ShellArguments<Real>& arguments, std::int32_t first, std::int32_t last);

/// The kernel without SIMD, in any precision.
template <class Real>
void shell_plainly(const ShellArguments<Real>& arguments, std::int32_t first, std::int32_t last);

}  // namespace frontalis
