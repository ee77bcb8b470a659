#pragma once

#include "frontalis/physics/invariant_bounds.hpp"

namespace frontalis
{
namespace physics
{

/// Arguments of exponential laws beyond this go on along the tangent: stiff, but finite in single precision.
constexpr double exponent_limit = 20;

/// e^x, and beyond the limit its tangent there: C1, finite.
template <class T>
FRONTALIS_LAW T bounded_exponential(T x)
{
  using N = Number<T>;
  return N::exp(N::min(x, N::of(exponent_limit))) * (N::of(1) + N::max(x - N::of(exponent_limit), N::of(0)));
}

/// Derivative of bounded_exponential.
template <class T>
FRONTALIS_LAW T bounded_exponential_slope(T x)
{
  return Number<T>::exp(Number<T>::min(x, Number<T>::of(exponent_limit)));
}

/// Isochoric Fung-type exponential solid: psi = mu / (2 b) (e^(b (g I1 - 3)) - 1), g = J^(-2/3) (Demiray 1972, J.
/// Biomech. 5:309), continued below a small J with g. Shear modulus at rest mu.
template <class T>
struct FungExponential
{
  T mu;  ///< [Pa]
  T b;   ///< stiffening, > 0 [-]
};

/// Adds the first Piola-Kirchhoff stress [Pa] to P.
template <class T>
FRONTALIS_LAW void add_stress(const FungExponential<T>& material, const Kinematics<T>& k, Matrix3<T>& P)
{
  using N = Number<T>;
  const IsochoricScale<T> g = isochoric_scale(k.J);
  const T half = N::of(0.5) * material.mu * bounded_exponential_slope(material.b * (g.value * k.I1 - N::of(3)));
  const T on_gradient = N::of(2) * half * g.value;
  const T on_cofactor = half * g.slope * k.I1;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      P.a[i][j] = P.a[i][j] + on_gradient * k.F.a[i][j] + on_cofactor * k.cofactor.a[i][j];
}

/// Strain energy a volume at rest [J/m3].
template <class T>
FRONTALIS_LAW T energy(const FungExponential<T>& material, const Kinematics<T>& k)
{
  using N = Number<T>;
  const T x = material.b * (isochoric_scale(k.J).value * k.I1 - N::of(3));
  return N::of(0.5) * material.mu / material.b * (bounded_exponential(x) - N::of(1));
}

/// Bound of the tangent shear stiffness [Pa]: half of the second derivative of the energy along any unit change of F.
template <class T>
FRONTALIS_LAW T tangent_stiffness(const FungExponential<T>& material, const Kinematics<T>& k)
{
  using N = Number<T>;
  const InvariantDerivatives<T> d = first_invariant_derivatives(k);
  return N::of(0.25) * material.mu *
         bounded_exponential_slope(material.b * (isochoric_scale(k.J).value * k.I1 - N::of(3))) *
         (material.b * d.first_squared + d.second);
}

}  // namespace physics
}  // namespace frontalis
