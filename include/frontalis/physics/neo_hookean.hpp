#pragma once

#include "frontalis/physics/isochoric.hpp"
#include "frontalis/physics/voxel_element.hpp"

namespace frontalis
{
namespace physics
{

/// Compressible neo-Hookean solid with isochoric split: psi = mu/2 (g(J) I1 - 3) + kappa/2 (J - 1)^2 with g = J^(-2/3)
/// (Bonet & Wood, Nonlinear Continuum Mechanics for Finite Element Analysis, 6.5), continued below a small J.
template <class T>
struct NeoHookean
{
  T mu;     ///< shear modulus [Pa]
  T kappa;  ///< bulk modulus [Pa]
};

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
  return { material.mu * g.value, N::of(0.5) * material.mu * g.slope * k.I1 + material.kappa * k.dilatation };
}

/// Strain energy per volume at rest [J/m3].
template <class T>
FRONTALIS_LAW T energy(const NeoHookean<T>& material, const Kinematics<T>& k)
{
  using N = Number<T>;
  return N::of(0.5) * material.mu * (isochoric_scale(k.J).value * k.I1 - N::of(3)) +
         N::of(0.5) * material.kappa * k.dilatation * k.dilatation;
}

}  // namespace physics
}  // namespace frontalis
