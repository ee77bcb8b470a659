#pragma once

#include "frontalis/physics/exponential.hpp"
#include "frontalis/physics/invariant_bounds.hpp"
#include "frontalis/physics/materials/description.hpp"

namespace frontalis::physics
{

/// Transversely isotropic Fung-type solid (Guccione, McCulloch & Waldman 1991, J. Biomech. Eng. 113:42) of the
/// isochoric strain: psi = c/2 (e^Q - 1), Q = bf Eff^2 + bt (Ess^2 + Enn^2 + 2 Esn^2) + 2 bfs (Efs^2 + Efn^2), E = (g
/// F^T F - 1) / 2, f along the fibre. Below a small J, g is continued (IsochoricScale).
template <class T>
struct Guccione
{
  T c;    ///< [Pa]
  T bf;   ///< along the fibre, > 0 [-]
  T bt;   ///< across it, > 0 [-]
  T bfs;  ///< shear between the two, > 0 [-]

  static constexpr MaterialDescription description{
    "guccione",
    "Guccione",
    "c/2 times the largest of bf, bt and bfs",
    false,  // averaged
    1,      // directions
    { { "c", "stiffness", Measure::pressure, above_zero, 2e3 },
      { "bf", "stiffening along the fibre", Measure::number, above_zero, 8 },
      { "bt", "stiffening across the fibre", Measure::number, above_zero, 2 },
      { "bfs", "stiffening in shear between the two", Measure::number, above_zero, 4 } },
  };
};

/// Shear modulus [Pa] along the stiffest direction.
template <class T>
FRONTALIS_LAW T shear_modulus(const Guccione<T>& material)
{
  return Number<T>::of(0.5) * material.c * Number<T>::max(material.bf, Number<T>::max(material.bt, material.bfs));
}

/// Isochoric strain, Q and half of its gradient.
template <class T>
struct GuccioneStrain
{
  Matrix3<T> C;         ///< F^T F
  Matrix3<T> gradient;  ///< 1/2 dQ/dE
  T Q, squared;         ///< squared = E : E
};

template <class T>
FRONTALIS_LAW GuccioneStrain<T> guccione_strain(const Guccione<T>& material, const Kinematics<T>& k, T g,
                                                const Vec3<T>* fibre)
{
  using N = Number<T>;
  const T a[3] = { fibre->x, fibre->y, fibre->z };
  GuccioneStrain<T> s;
  T E[3][3], along[3];
  s.C = right_cauchy_green(k.F);
  s.squared = N::of(0);
  for (int i = 0; i < 3; ++i)
  {
    for (int j = 0; j < 3; ++j)
    {
      E[i][j] = N::of(0.5) * (i == j ? g * s.C.a[i][j] - N::of(1) : g * s.C.a[i][j]);
      s.squared = s.squared + E[i][j] * E[i][j];
    }
    along[i] = E[i][0] * a[0] + E[i][1] * a[1] + E[i][2] * a[2];
  }
  // With |E f|^2 = Eff^2 + Efs^2 + Efn^2, Q = on_fibre Eff^2 + 2 on_shear |E f|^2 + bt E : E.
  const T fibre_strain = a[0] * along[0] + a[1] * along[1] + a[2] * along[2];
  const T on_fibre = material.bf + material.bt - N::of(2) * material.bfs, on_shear = material.bfs - material.bt;
  s.Q = on_fibre * fibre_strain * fibre_strain +
        N::of(2) * on_shear * (along[0] * along[0] + along[1] * along[1] + along[2] * along[2]) +
        material.bt * s.squared;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      s.gradient.a[i][j] = on_fibre * fibre_strain * a[i] * a[j] + on_shear * (along[i] * a[j] + a[i] * along[j]) +
                           material.bt * E[i][j];
  return s;
}

/// Adds the first Piola-Kirchhoff stress [Pa] of the solid with fibres along the unit vector `fibre` at rest to P.
template <class T>
FRONTALIS_LAW void add_stress(const Guccione<T>& material, const Kinematics<T>& k, const Vec3<T>* fibre, Matrix3<T>& P)
{
  using N = Number<T>;
  const IsochoricScale<T> g = isochoric_scale(k.J);
  const GuccioneStrain<T> s = guccione_strain(material, k, g.value, fibre);
  const T scale = material.c * bounded_exponential_slope(s.Q);
  T along = N::of(0);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      along = along + s.gradient.a[i][j] * s.C.a[i][j];
  const T on_strain = scale * g.value, on_cofactor = N::of(0.5) * scale * g.slope * along;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      P.a[i][j] = P.a[i][j] + on_cofactor * k.cofactor.a[i][j] +
                  on_strain * (k.F.a[i][0] * s.gradient.a[0][j] + k.F.a[i][1] * s.gradient.a[1][j] +
                               k.F.a[i][2] * s.gradient.a[2][j]);
}

/// Strain energy per volume at rest [J/m3].
template <class T>
FRONTALIS_LAW T energy(const Guccione<T>& material, const Kinematics<T>& k, const Vec3<T>* fibre)
{
  const T Q = guccione_strain(material, k, isochoric_scale(k.J).value, fibre).Q;
  return Number<T>::of(0.5) * material.c * (bounded_exponential(Q) - Number<T>::of(1));
}

/// Bound of the tangent shear stiffness [Pa]: half of the second derivative of the energy along any unit change of F,
/// c/2 e^Q ((dQ)^2 + d2Q). The first derivative dQ is exact. The second, d2Q, is bounded by the norms of dE and d2E;
/// the squared norm of dE is bounded by its exact value at rest, 1, plus the growth of its bound since rest.
template <class T>
FRONTALIS_LAW T tangent_stiffness(const Guccione<T>& material, const Kinematics<T>& k, const Vec3<T>* fibre)
{
  using N = Number<T>;
  const IsochoricScale<T> g = isochoric_scale(k.J);
  const GuccioneStrain<T> s = guccione_strain(material, k, g.value, fibre);
  const T bend = isochoric_bend(g, k.J);
  T gradient_squared = N::of(0), cofactor_squared = N::of(0), strain_squared = N::of(0), along = N::of(0);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
    {
      gradient_squared = gradient_squared + s.gradient.a[i][j] * s.gradient.a[i][j];
      cofactor_squared = cofactor_squared + k.cofactor.a[i][j] * k.cofactor.a[i][j];
      strain_squared = strain_squared + s.C.a[i][j] * s.C.a[i][j];
      along = along + s.gradient.a[i][j] * s.C.a[i][j];
    }
  T first_squared = N::of(0);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
    {
      const T x =
          g.slope * along * k.cofactor.a[i][j] +
          N::of(2) * g.value *
              (k.F.a[i][0] * s.gradient.a[0][j] + k.F.a[i][1] * s.gradient.a[1][j] + k.F.a[i][2] * s.gradient.a[2][j]);
      first_squared = first_squared + x * x;
    }
  const T stretch = N::sqrt(k.I1), turn = -g.slope * N::sqrt(cofactor_squared), C = N::sqrt(strain_squared);
  const T change = g.value * stretch + N::of(0.5) * turn * C;
  const double at_rest = 7.4641016151377544;  // (1 + sqrt(3))^2
  const T change_squared = N::of(1) + N::max(change * change - N::of(at_rest), N::of(0));
  const T bent = g.value + N::of(2) * turn * stretch + N::of(0.5) * bend * cofactor_squared * C -
                 N::of(1 / 1.7320508075688772) * g.slope * stretch * C;
  const T largest = N::max(material.bf, N::max(material.bt, material.bfs));
  return N::of(0.25) * material.c * bounded_exponential_slope(s.Q) *
         (first_squared + N::of(2) * largest * change_squared + N::of(2) * N::sqrt(gradient_squared) * bent);
}

}  // namespace frontalis::physics
