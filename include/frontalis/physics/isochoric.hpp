#pragma once

#include "frontalis/physics/mutation.hpp"
#include "frontalis/physics/voxel_element.hpp"

namespace frontalis::physics
{

/// Below this J the isochoric laws are replaced by a smooth continuation; above it they hold exactly.
constexpr double continuation_jacobian = 0.2;

/// g(J) = J^(-2/3) and its derivative. Below J0 = continuation_jacobian, g continues along its tangent, so that the
/// energy has a continuous derivative with respect to F. The continuation is finite at J <= 0 and still grows as J
/// falls, so that it opens a crushed or inverted element. (Smith, de Goes & Kim 2018 achieve the same with a
/// regularised energy.)
template <class T>
struct IsochoricScale
{
  T value;  ///< g
  T slope;  ///< dg/dJ
};

template <class T>
FRONTALIS_LAW IsochoricScale<T> isochoric_scale(T J)
{
  using N = Number<T>;
  const double j0 = mutation::laws_not_continued ? -1e6 : continuation_jacobian;
  const T y = N::inverse_cube_root(N::max(J, N::of(j0)));
  const T y2 = y * y;
  const T slope = N::of(-2.0 / 3.0) * y2 * y2 * y;
  return { y2 + slope * N::min(J - N::of(j0), N::of(0)), slope };
}

/// g'' = 10/9 J^(-8/3) = 5/2 g'^2 / g, and 0 where g continues along its tangent.
template <class T>
FRONTALIS_LAW T isochoric_bend(const IsochoricScale<T>& g, T J)
{
  using N = Number<T>;
  return N::select(J > N::of(continuation_jacobian), N::of(2.5) * g.slope * g.slope / g.value, N::of(0));
}

/// Adds on_gradient F + on_cofactor cof F to a stress P.
template <class T>
FRONTALIS_LAW void add_isotropic(const Kinematics<T>& k, const T& on_gradient, const T& on_cofactor, Matrix3<T>& P)
{
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      P.a[i][j] = P.a[i][j] + on_gradient * k.F.a[i][j] + on_cofactor * k.cofactor.a[i][j];
}

}  // namespace frontalis::physics
