#pragma once

#include "frontalis/physics/number.hpp"

namespace frontalis
{
namespace physics
{

/// In-place 8-point Walsh-Hadamard transform of one displacement component at the corners b = i + 2j + 4k of a box
/// voxel. Afterwards index 0 holds the sum; 1, 2, 4 hold 4 h times the mean derivative along x, y, z; 3, 5, 6, 7 hold
/// the hourglass modes, which on a box are orthogonal to every linear field (one-point quadrature of the trilinear
/// hexahedron, Flanagan & Belytschko 1981, specialised to boxes).
template <class T>
FRONTALIS_LAW void walsh_hadamard(T* a)
{
  FRONTALIS_UNROLL
  for (int s = 1; s < 8; s *= 2)
    for (int b = 0; b < 8; ++b)
      if (!(b & s))
      {
        const T low = a[b], high = a[b | s];
        a[b] = low + high;
        a[b | s] = high - low;
      }
}

/// Transpose of walsh_hadamard(), in place: converts generalised forces on the modes to forces on the corners.
template <class T>
FRONTALIS_LAW void walsh_hadamard_transposed(T* a)
{
  FRONTALIS_UNROLL
  for (int s = 1; s < 8; s *= 2)
    for (int b = 0; b < 8; ++b)
      if (!(b & s))
      {
        const T low = a[b], high = a[b | s];
        a[b] = low - high;
        a[b | s] = low + high;
      }
}

/// Mode that holds the derivative along axis 0, 1, 2.
FRONTALIS_LAW constexpr int gradient_mode(int axis) { return 1 << axis; }

/// Deformation of an element at its centre, and quantities that several laws need.
template <class T>
struct Kinematics
{
  Matrix3<T> F;         ///< deformation gradient
  Matrix3<T> cofactor;  ///< dJ/dF
  T J;                  ///< det F
  T dilatation;         ///< J - 1, without the rounding error of a J near 1
  T I1;                 ///< trace of F^T F
};

/// Kinematics from the transformed displacements of the three components; scale[j] = 1 / (4 h_j).
template <class T, class S>
FRONTALIS_LAW Kinematics<T> kinematics(const T* x, const T* y, const T* z, const S* scale)
{
  Kinematics<T> k;
  const T* component[3] = { x, y, z };
  const T one = Number<T>::of(1);
  T stretch[3];  // stretch of each axis, minus 1
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
    {
      k.F.a[i][j] = component[i][gradient_mode(j)] * T(scale[j]);
      if (i == j)
      {
        stretch[i] = k.F.a[i][i];
        k.F.a[i][i] = stretch[i] + one;
      }
    }
  const auto& F = k.F.a;
  auto& c = k.cofactor.a;
  const T first = stretch[1] + stretch[2] + (stretch[1] * stretch[2] - F[1][2] * F[2][1]);
  c[0][0] = first + one;
  c[0][1] = F[1][2] * F[2][0] - F[1][0] * F[2][2];
  c[0][2] = F[1][0] * F[2][1] - F[1][1] * F[2][0];
  c[1][0] = F[0][2] * F[2][1] - F[0][1] * F[2][2];
  c[1][1] = F[0][0] * F[2][2] - F[0][2] * F[2][0];
  c[1][2] = F[0][1] * F[2][0] - F[0][0] * F[2][1];
  c[2][0] = F[0][1] * F[1][2] - F[0][2] * F[1][1];
  c[2][1] = F[0][2] * F[1][0] - F[0][0] * F[1][2];
  c[2][2] = F[0][0] * F[1][1] - F[0][1] * F[1][0];
  k.dilatation = first + (stretch[0] * c[0][0] + F[0][1] * c[0][1] + F[0][2] * c[0][2]);
  k.J = k.dilatation + one;
  k.I1 = F[0][0] * F[0][0] + F[0][1] * F[0][1] + F[0][2] * F[0][2] + F[1][0] * F[1][0] + F[1][1] * F[1][1] +
         F[1][2] * F[1][2] + F[2][0] * F[2][0] + F[2][1] * F[2][1] + F[2][2] * F[2][2];
  return k;
}

}  // namespace physics
}  // namespace frontalis
