#pragma once

#include "frontalis/physics/isochoric.hpp"

namespace frontalis::physics
{

/// The right Cauchy-Green tensor C = F^T F.
template <class T>
FRONTALIS_LAW Matrix3<T> right_cauchy_green(const Matrix3<T>& F)
{
  Matrix3<T> C;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      C.a[i][j] = F.a[0][i] * F.a[0][j] + F.a[1][i] * F.a[1][j] + F.a[2][i] * F.a[2][j];
  return C;
}

/// Second invariant of C, (I1^2 - tr C^2) / 2.
template <class T>
FRONTALIS_LAW T second_invariant(const Matrix3<T>& C)
{
  return C.a[0][0] * C.a[1][1] + C.a[1][1] * C.a[2][2] + C.a[2][2] * C.a[0][0] - C.a[0][1] * C.a[0][1] -
         C.a[1][2] * C.a[1][2] - C.a[2][0] * C.a[2][0];
}

/// Derivatives of an isochoric invariant g w with respect to F, for the bound of the time step; g is IsochoricScale.
template <class T>
struct InvariantDerivatives
{
  T first_squared;  ///< squared norm of the first derivative, exact
  T second;         ///< bound of the second derivative along a unit change of F, term by term
};

/// Derivatives of g w, where w is the trace of F^T F (lines = 3) or the squared stretch of one material line (lines =
/// 1). The first derivative is g w' + w g' cof F with |w'|^2 = 4 w and w' : cof F = 2 lines J.
template <class T>
FRONTALIS_LAW InvariantDerivatives<T> invariant_derivatives(const Kinematics<T>& k, const T& w, double lines)
{
  using N = Number<T>;
  T cofactor_squared = N::of(0);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      cofactor_squared = cofactor_squared + k.cofactor.a[i][j] * k.cofactor.a[i][j];
  const IsochoricScale<T> g = isochoric_scale(k.J);
  const T bend = isochoric_bend(g, k.J);
  const T first = N::of(4) * g.value * g.value * w + N::of(4 * lines) * g.value * g.slope * w * k.J +
                  g.slope * g.slope * w * w * cofactor_squared;
  const T second = N::of(2) * g.value - N::of(4) * g.slope * N::sqrt(w * cofactor_squared) +
                   w * (bend * cofactor_squared - N::of(2 / 1.7320508075688772) * g.slope * N::sqrt(k.I1));
  return { N::max(first, N::of(0)), second };
}

/// Derivatives of g I1. The bound of the second derivative is its exact value at rest, 4, plus the growth of the
/// term-by-term bound since rest.
template <class T>
FRONTALIS_LAW InvariantDerivatives<T> first_invariant_derivatives(const Kinematics<T>& k)
{
  using N = Number<T>;
  InvariantDerivatives<T> d = invariant_derivatives(k, k.I1, 3);
  d.second = N::of(4) + N::max(d.second - N::of(2 + 8 + 10 + 4), N::of(0));
  return d;
}

}  // namespace frontalis::physics
