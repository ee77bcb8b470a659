#pragma once

#include "frontalis/physics/voxel_element.hpp"

namespace frontalis
{
namespace physics
{

/// Selective reduced integration of a box voxel: the isochoric stress is taken at the eight Gauss points, the
/// volumetric stress at the centre (Hughes 1980, Int. J. Numer. Meth. Eng. 15:1413). Here the energy is split into
/// these two parts, so that the forces are its gradient. The derivative of the transformed displacements q along x at
/// the Gauss point (s_x, s_y, s_z), s = +-1 / sqrt(3), is (q1 + s_y q3 + s_z q5 + s_y s_z q7) / (4 h_x), so that the
/// hourglass modes q3, q5 and q7 have stiffness.
constexpr double gauss_coordinate = 0.57735026918962576;  // 1 / sqrt(3)

/// Coordinate of one of the eight Gauss points along an axis.
FRONTALIS_LAW constexpr double gauss_point(int point, int axis)
{
  return point & (1 << axis) ? gauss_coordinate : -gauss_coordinate;
}

/// Contribution of a mode to the derivative along `axis` at a point: 1 for the mode of that derivative, 0 for modes
/// that do not vary along the axis.
FRONTALIS_LAW constexpr double gauss_weight(int point, int axis, int mode)
{
  double weight = mode & (1 << axis) ? 1 : 0;
  for (int other = 0; other < 3; ++other)
    if (other != axis && (mode & (1 << other)))
      weight *= gauss_point(point, other);
  return weight;
}

/// Transformed displacements whose mean gradient is the gradient of q at a Gauss point, for kinematics().
template <class T>
FRONTALIS_LAW void at_gauss_point(int point, const T (&q)[3][8], T (&moved)[3][8])
{
  using N = Number<T>;
  for (int c = 0; c < 3; ++c)
    for (int axis = 0; axis < 3; ++axis)
    {
      T sum = q[c][gradient_mode(axis)];
      for (int m = 3; m < 8; ++m)
        if (m != 4 && (m & (1 << axis)))
          sum = sum + N::of(gauss_weight(point, axis, m)) * q[c][m];
      moved[c][gradient_mode(axis)] = sum;
    }
}

/// Adds the modal forces of a stress P at a Gauss point; scale as in kinematics().
template <class T, class S>
FRONTALIS_LAW void add_gauss_forces(int point, const Matrix3<T>& P, const S* scale, T (&force)[3][8])
{
  using N = Number<T>;
  for (int c = 0; c < 3; ++c)
    for (int axis = 0; axis < 3; ++axis)
    {
      const T part = N::of(0.125) * P.a[c][axis] * T(scale[axis]);
      for (int m = 1; m < 8; ++m)
        if (m & (1 << axis))
          force[c][m] = force[c][m] + N::of(gauss_weight(point, axis, m)) * part;
    }
}

}  // namespace physics
}  // namespace frontalis
