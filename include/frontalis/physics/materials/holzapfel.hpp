#pragma once

#include "frontalis/physics/exponential.hpp"
#include "frontalis/physics/invariant_bounds.hpp"
#include "frontalis/physics/materials/description.hpp"

namespace frontalis::physics
{

/// Two dispersed families of collagen fibres in an isochoric neo-Hookean matrix (Gasser, Ogden & Holzapfel 2006, J. R.
/// Soc. Interface 3:15): psi = mu/2 (g I1 - 3) + sum k1 / (2 k2) (e^(k2 E^2) - 1), E = d (g I1 - 3) + (1 - 3 d) (g I4 -
/// 1). Fibres carry tension only (E > 0). Below a small J, g is continued (IsochoricScale).
template <class T>
struct HolzapfelGasserOgden
{
  T mu;          ///< matrix [Pa]
  T k1;          ///< fibre stiffness [Pa]
  T k2;          ///< fibre stiffening, > 0 [-]
  T dispersion;  ///< d: 0 (aligned) to 1/3 (isotropic)

  static constexpr MaterialDescription description{
    "holzapfel",
    "Holzapfel-Gasser-Ogden",
    "shear",
    false,  // averaged
    2,      // directions
    { { "shear", "shear modulus of the matrix", Measure::pressure, above_zero, 5e3 },
      { "k1", "stiffness of the fibres", Measure::pressure, from_zero, 6e3 },
      { "k2", "stiffening of the fibres", Measure::number, above_zero, 0.8 },
      { "dispersion", "dispersion of the fibres", Measure::number, { 0, 1.0 / 3, true, true }, 0.1 } },
  };
};

template <class T>
FRONTALIS_LAW T shear_modulus(const HolzapfelGasserOgden<T>& material)
{
  return material.mu;
}

/// Fibre strain E and |F a0|^2 of the family along a0 (unit length).
template <class T>
struct FibreFamily
{
  Vec3<T> along;  ///< F a0
  T strain;       ///< E, 0 if the family is slack
};

template <class T>
FRONTALIS_LAW FibreFamily<T> fibre_family(const HolzapfelGasserOgden<T>& material, const Kinematics<T>& k, T g,
                                          const Vec3<T>& a)
{
  using N = Number<T>;
  const auto& F = k.F.a;
  FibreFamily<T> family;
  family.along = { F[0][0] * a.x + F[0][1] * a.y + F[0][2] * a.z, F[1][0] * a.x + F[1][1] * a.y + F[1][2] * a.z,
                   F[2][0] * a.x + F[2][1] * a.y + F[2][2] * a.z };
  const T strain = material.dispersion * (g * k.I1 - N::of(3)) +
                   (N::of(1) - N::of(3) * material.dispersion) * (g * dot(family.along, family.along) - N::of(1));
  family.strain = N::max(strain, N::of(0));
  return family;
}

/// Adds the first Piola-Kirchhoff stress [Pa] of the matrix and of the families along a0[0], a0[1] to P.
template <class T>
FRONTALIS_LAW void add_stress(const HolzapfelGasserOgden<T>& material, const Kinematics<T>& k, const Vec3<T>* a0,
                              Matrix3<T>& P)
{
  using N = Number<T>;
  const IsochoricScale<T> g = isochoric_scale(k.J);
  const T aligned = N::of(1) - N::of(3) * material.dispersion;
  T on_gradient = material.mu * g.value;
  T on_cofactor = N::of(0.5) * material.mu * g.slope * k.I1;
  for (int f = 0; f < 2; ++f)
  {
    const FibreFamily<T> family = fibre_family(material, k, g.value, a0[f]);
    const T slope =
        material.k1 * family.strain * bounded_exponential_slope(material.k2 * family.strain * family.strain);
    on_gradient = on_gradient + N::of(2) * slope * material.dispersion * g.value;
    on_cofactor =
        on_cofactor + slope * g.slope * (material.dispersion * k.I1 + aligned * dot(family.along, family.along));
    const T on_fibre = N::of(2) * slope * aligned * g.value;
    const T along[3] = { family.along.x, family.along.y, family.along.z };
    const T a[3] = { a0[f].x, a0[f].y, a0[f].z };
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        P.a[i][j] = P.a[i][j] + on_fibre * along[i] * a[j];
  }
  add_isotropic(k, on_gradient, on_cofactor, P);
}

/// Strain energy per volume at rest [J/m3].
template <class T>
FRONTALIS_LAW T energy(const HolzapfelGasserOgden<T>& material, const Kinematics<T>& k, const Vec3<T>* a0)
{
  using N = Number<T>;
  const T g = isochoric_scale(k.J).value;
  T sum = N::of(0.5) * material.mu * (g * k.I1 - N::of(3));
  for (int f = 0; f < 2; ++f)
  {
    const T strain = fibre_family(material, k, g, a0[f]).strain;
    sum =
        sum + N::of(0.5) * material.k1 / material.k2 * (bounded_exponential(material.k2 * strain * strain) - N::of(1));
  }
  return sum;
}

/// Bound of the tangent shear stiffness [Pa]: half of the second derivative of the energy along any unit change of F.
/// Slack families count as if they were taut.
template <class T>
FRONTALIS_LAW T tangent_stiffness(const HolzapfelGasserOgden<T>& material, const Kinematics<T>& k, const Vec3<T>* a0)
{
  using N = Number<T>;
  const T g = isochoric_scale(k.J).value;
  const InvariantDerivatives<T> all = first_invariant_derivatives(k);
  const T aligned = N::of(1) - N::of(3) * material.dispersion;
  T sum = N::of(0.25) * material.mu * all.second;
  for (int f = 0; f < 2; ++f)
  {
    const FibreFamily<T> family = fibre_family(material, k, g, a0[f]);
    const T squared = dot(family.along, family.along);
    const InvariantDerivatives<T> own = invariant_derivatives(k, squared, 1);
    const T first = material.dispersion * N::sqrt(all.first_squared) + aligned * N::sqrt(own.first_squared);
    const T exponent = material.k2 * family.strain * family.strain;
    sum = sum + N::of(0.5) * material.k1 * bounded_exponential_slope(exponent) *
                    ((N::of(1) + N::of(2) * exponent) * N::max(first * first, N::of(4) * g * g * squared) +
                     family.strain * (material.dispersion * all.second + aligned * own.second));
  }
  return sum;
}

}  // namespace frontalis::physics
