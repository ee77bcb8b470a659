#pragma once

#include "frontalis/physics/exponential.hpp"
#include "frontalis/physics/invariant_bounds.hpp"
#include "frontalis/physics/materials/description.hpp"

namespace frontalis::physics
{

/// Isochoric Fung-type exponential solid: psi = mu / (2 b) (e^(b (g I1 - 3)) - 1), g = J^(-2/3) (Demiray 1972, J.
/// Biomech. 5:309). Below a small J, g is continued (IsochoricScale).
template <class T>
struct FungExponential
{
  T mu;  ///< [Pa]
  T b;   ///< stiffening, > 0 [-]

  static constexpr MaterialDescription description{
    "fung",
    "Fung",
    "shear",
    true,  // averaged
    0,     // directions
    { { "shear", "shear modulus at rest", Measure::pressure, above_zero, 8e3 },
      { "b", "stiffening", Measure::number, above_zero, 1.5 } },
  };
};

template <class T>
FRONTALIS_LAW T shear_modulus(const FungExponential<T>& material)
{
  return material.mu;
}

/// Adds the first Piola-Kirchhoff stress [Pa] to P.
template <class T>
FRONTALIS_LAW void add_stress(const FungExponential<T>& material, const Kinematics<T>& k, Matrix3<T>& P)
{
  using N = Number<T>;
  const IsochoricScale<T> g = isochoric_scale(k.J);
  const T half = N::of(0.5) * material.mu * bounded_exponential_slope(material.b * (g.value * k.I1 - N::of(3)));
  add_isotropic(k, N::of(2) * half * g.value, half * g.slope * k.I1, P);
}

/// Strain energy per volume at rest [J/m3].
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

}  // namespace frontalis::physics
