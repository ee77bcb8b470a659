#pragma once

#include "frontalis/physics/invariant_bounds.hpp"
#include "frontalis/physics/materials/description.hpp"

namespace frontalis::physics
{

/// Compressible neo-Hookean solid with isochoric split: psi = mu/2 x + kappa/2 (J - 1)^2 with x = g(J) I1 - 3 and g =
/// J^(-2/3) (Bonet & Wood, Nonlinear Continuum Mechanics for Finite Element Analysis, 6.5). Stiffening b makes it the
/// solid of Yeoh (1990, Rubber Chem. Technol. 63:792) with two terms: mu/2 (x + b/2 x^2), whose shear modulus doubles
/// at x = 1 / b. Below a small J, g is continued (IsochoricScale). The solid includes the volumetric part of all
/// materials; with kappa = 0 it is purely isochoric like the other laws.
template <class T>
struct NeoHookean
{
  T mu;          ///< shear modulus at rest [Pa]
  T kappa;       ///< bulk modulus [Pa]
  T stiffening;  ///< b, >= 0 [-]

  static constexpr MaterialDescription description{
    "neo_hookean",
    "neo-Hookean",
    "young / (2 (1 + poisson))",
    true,  // averaged
    0,     // directions
    { { "young", "Young's modulus", Measure::young_modulus, above_zero, 30e3 },
      { "stiffening", "stiffening", Measure::number, from_zero, 0.3, true } },
  };
};

template <class T>
FRONTALIS_LAW T shear_modulus(const NeoHookean<T>& material)
{
  return material.mu;
}

/// Shear modulus [Pa] that relates stress to strain at an isochoric first invariant g I1: 2 d psi / d x. The invariant
/// is 3 or more but in crushed voxels, where g is continued: there x counts as 0.
template <class T>
FRONTALIS_LAW T secant_modulus(const NeoHookean<T>& material, const T& invariant)
{
  using N = Number<T>;
  return material.mu + material.mu * material.stiffening * N::max(invariant - N::of(3), N::of(0));
}

/// First Piola-Kirchhoff stress [Pa] as P = on_gradient F + on_cofactor cof F.
template <class T>
struct IsotropicStress
{
  T on_gradient;
  T on_cofactor;
};

template <class T>
FRONTALIS_LAW IsotropicStress<T> stress(const NeoHookean<T>& material, const Kinematics<T>& k)
{
  using N = Number<T>;
  const IsochoricScale<T> g = isochoric_scale(k.J);
  const T mu = secant_modulus(material, g.value * k.I1);
  return { mu * g.value, N::of(0.5) * mu * g.slope * k.I1 + material.kappa * k.dilatation };
}

/// Adds the first Piola-Kirchhoff stress [Pa] to P.
template <class T>
FRONTALIS_LAW void add_stress(const NeoHookean<T>& material, const Kinematics<T>& k, Matrix3<T>& P)
{
  const IsotropicStress<T> s = stress(material, k);
  add_isotropic(k, s.on_gradient, s.on_cofactor, P);
}

/// Strain energy per volume at rest [J/m3].
template <class T>
FRONTALIS_LAW T energy(const NeoHookean<T>& material, const Kinematics<T>& k)
{
  using N = Number<T>;
  const T x = isochoric_scale(k.J).value * k.I1 - N::of(3);
  const T stretched = N::max(x, N::of(0));
  return N::of(0.5) * material.mu * (x + N::of(0.5) * material.stiffening * stretched * stretched) +
         N::of(0.5) * material.kappa * k.dilatation * k.dilatation;
}

/// Bound of the tangent shear stiffness [Pa]: half of the second derivative of the energy along any unit change of F.
template <class T>
FRONTALIS_LAW T tangent_stiffness(const NeoHookean<T>& material, const Kinematics<T>& k)
{
  using N = Number<T>;
  const InvariantDerivatives<T> d = first_invariant_derivatives(k);
  return N::of(0.25) * (secant_modulus(material, isochoric_scale(k.J).value * k.I1) * d.second +
                        material.mu * material.stiffening * d.first_squared);
}

}  // namespace frontalis::physics
