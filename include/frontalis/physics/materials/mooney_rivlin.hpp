#pragma once

#include "frontalis/physics/invariant_bounds.hpp"
#include "frontalis/physics/materials/description.hpp"

namespace frontalis::physics
{

/// Isochoric Mooney-Rivlin solid: psi = c1 (g I1 - 3) + c2 (g^2 I2 - 3), g = J^(-2/3) (Bonet & Wood, 6.5). Below a
/// small J, g is continued (IsochoricScale).
template <class T>
struct MooneyRivlin
{
  T c1;  ///< [Pa]
  T c2;  ///< [Pa]

  static constexpr MaterialDescription description{
    "mooney_rivlin",
    "Mooney-Rivlin",
    "2 (c1 + c2)",
    true,  // averaged
    0,     // directions
    { { "c1", "coefficient of the first invariant", Measure::pressure, above_zero, 4e3 },
      { "c2", "coefficient of the second invariant", Measure::pressure, from_zero, 1e3 } },
  };
};

template <class T>
FRONTALIS_LAW T shear_modulus(const MooneyRivlin<T>& material)
{
  return Number<T>::of(2) * (material.c1 + material.c2);
}

/// Adds the first Piola-Kirchhoff stress [Pa] to P.
template <class T>
FRONTALIS_LAW void add_stress(const MooneyRivlin<T>& material, const Kinematics<T>& k, Matrix3<T>& P)
{
  using N = Number<T>;
  const IsochoricScale<T> g = isochoric_scale(k.J);
  const Matrix3<T> C = right_cauchy_green(k.F);
  const T twice = N::of(2) * material.c2 * g.value;
  const T on_gradient = N::of(2) * material.c1 * g.value + twice * g.value * k.I1;
  const T on_product = twice * g.value;
  const T on_cofactor = g.slope * (material.c1 * k.I1 + twice * second_invariant(C));
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      P.a[i][j] = P.a[i][j] + on_gradient * k.F.a[i][j] + on_cofactor * k.cofactor.a[i][j] -
                  on_product * (k.F.a[i][0] * C.a[0][j] + k.F.a[i][1] * C.a[1][j] + k.F.a[i][2] * C.a[2][j]);
}

/// Strain energy per volume at rest [J/m3].
template <class T>
FRONTALIS_LAW T energy(const MooneyRivlin<T>& material, const Kinematics<T>& k)
{
  using N = Number<T>;
  const T g = isochoric_scale(k.J).value;
  return material.c1 * (g * k.I1 - N::of(3)) +
         material.c2 * (g * g * second_invariant(right_cauchy_green(k.F)) - N::of(3));
}

/// Bound of the tangent shear stiffness [Pa]: half of the second derivative of the energy along any unit change of F.
/// The second derivative of g^2 I2, with I2 = |cof F|^2, is bounded by its exact value at rest, 4, plus the growth of
/// its term-by-term bound since rest.
template <class T>
FRONTALIS_LAW T tangent_stiffness(const MooneyRivlin<T>& material, const Kinematics<T>& k)
{
  using N = Number<T>;
  const double root = 1.7320508075688772;
  const IsochoricScale<T> g = isochoric_scale(k.J);
  const T bend = isochoric_bend(g, k.J);
  const T I2 = second_invariant(right_cauchy_green(k.F)), steep = -g.value * g.slope, stretch = N::sqrt(k.I1);
  const T second = g.value * g.value * (N::of(2) * k.I1 + N::of(4 / root) * N::sqrt(I2)) +
                   I2 * (N::of(8) * steep * stretch + N::of(2) * (g.slope * g.slope + g.value * bend) * I2 +
                         N::of(4 / root) * steep * stretch);
  const double at_rest = 6 + 4 + 16 * root + 28 + 8;
  return N::of(0.5) * (material.c1 * first_invariant_derivatives(k).second +
                       material.c2 * (N::of(4) + N::max(second - N::of(at_rest), N::of(0))));
}

}  // namespace frontalis::physics
