#pragma once

#include "frontalis/physics/invariant_bounds.hpp"
#include "frontalis/physics/materials/description.hpp"
#include "frontalis/physics/symmetric_eigen.hpp"

namespace frontalis::physics
{

/// Isochoric Ogden solid of two terms: psi = sum_p mu_p / alpha_p (sum_a (g c_a)^(alpha_p / 2) - 3), with the
/// eigenvalues c_a of C and g = J^(-2/3) (Ogden 1972). Below a small J, a multiple of the identity is added to C. It
/// grows smoothly as J falls, so that no power of a vanishing stretch is taken.
template <class T>
struct Ogden
{
  T mu1;     ///< [Pa]
  T alpha1;  ///< exponent, not 0 [-]
  T mu2;     ///< [Pa]
  T alpha2;  ///< exponent, not 0 [-]

  static constexpr MaterialDescription description{
    "ogden",
    "Ogden",
    "(mu1 alpha1 + mu2 alpha2) / 2",
    false,  // averaged
    0,      // directions
    { { "mu1", "coefficient of the first term", Measure::pressure, any_value, 6e3 },
      { "alpha1", "exponent of the first term", Measure::number, not_zero, 2.5 },
      { "mu2", "coefficient of the second term", Measure::pressure, any_value, -2e3 },
      { "alpha2", "exponent of the second term", Measure::number, not_zero, -2 } },
  };
};

template <class T>
FRONTALIS_LAW T shear_modulus(const Ogden<T>& material)
{
  return Number<T>::of(0.5) * (material.mu1 * material.alpha1 + material.mu2 * material.alpha2);
}

template <class T>
struct OgdenTerms
{
  struct Term
  {
    T mu, alpha;
  };
  Term terms[2];
  FRONTALIS_LAW const Term* begin() const { return terms; }
  FRONTALIS_LAW const Term* end() const { return terms + 2; }
};

template <class T>
FRONTALIS_LAW OgdenTerms<T> terms_of(const Ogden<T>& material)
{
  return { { { material.mu1, material.alpha1 }, { material.mu2, material.alpha2 } } };
}

/// Multiple of the identity that is added to C below continuation_jacobian: value and derivative with respect to J.
template <class T>
FRONTALIS_LAW IsochoricScale<T> eigenvalue_shift(T J)
{
  using N = Number<T>;
  const double j0 = continuation_jacobian;
  const T below = N::max(N::of(1) - J * N::of(1 / j0), N::of(0));
  return { N::of(j0 * j0) * below * below, N::of(-2 * j0) * below };
}

/// Adds the first Piola-Kirchhoff stress [Pa] to P.
template <class T>
FRONTALIS_LAW void add_stress(const Ogden<T>& material, const Kinematics<T>& k, Matrix3<T>& P)
{
  using N = Number<T>;
  const IsochoricScale<T> g = isochoric_scale(k.J);
  const IsochoricScale<T> shift = eigenvalue_shift(k.J);
  const SymmetricEigen<T> eigen = symmetric_eigen(right_cauchy_green(k.F));
  T slope[3];  // 2 d psi / d c_a
  T on_g = N::of(0), trace = N::of(0);
  for (int a = 0; a < 3; ++a)
  {
    const T c = N::max(eigen.value[a] + shift.value, N::of(1e-6));
    const T logarithm = N::log(g.value * c);
    T sum = N::of(0);
    for (const auto& term : terms_of(material))
      sum = sum + term.mu * N::exp(N::of(0.5) * term.alpha * logarithm);
    slope[a] = sum / c;
    trace = trace + slope[a];
    on_g = on_g + sum;
  }
  const T on_cofactor = N::of(0.5) * (on_g / g.value * g.slope + trace * shift.slope);
  Matrix3<T> S;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      S.a[i][j] = slope[0] * eigen.vector.a[i][0] * eigen.vector.a[j][0] +
                  slope[1] * eigen.vector.a[i][1] * eigen.vector.a[j][1] +
                  slope[2] * eigen.vector.a[i][2] * eigen.vector.a[j][2];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      P.a[i][j] = P.a[i][j] + on_cofactor * k.cofactor.a[i][j] + k.F.a[i][0] * S.a[0][j] + k.F.a[i][1] * S.a[1][j] +
                  k.F.a[i][2] * S.a[2][j];
}

/// Strain energy per volume at rest [J/m3].
template <class T>
FRONTALIS_LAW T energy(const Ogden<T>& material, const Kinematics<T>& k)
{
  using N = Number<T>;
  const T g = isochoric_scale(k.J).value;
  const SymmetricEigen<T> eigen = symmetric_eigen(right_cauchy_green(k.F));
  const T shift = eigenvalue_shift(k.J).value;
  T sum = N::of(0);
  for (const auto& term : terms_of(material))
  {
    T powers = N::of(-3);
    for (int a = 0; a < 3; ++a)
    {
      const T c = N::max(eigen.value[a] + shift, N::of(1e-6));
      powers = powers + N::exp(N::of(0.5) * term.alpha * N::log(g * c));
    }
    sum = sum + term.mu / term.alpha * powers;
  }
  return sum;
}

/// Bound of the tangent shear stiffness [Pa]. In principal directions the second derivative of a term's energy is that
/// of a power, on the diagonal, without its mean, plus the stress mu (trace / 3 - x_a).
template <class T>
FRONTALIS_LAW T tangent_stiffness(const Ogden<T>& material, const Kinematics<T>& k)
{
  using N = Number<T>;
  const T g = isochoric_scale(k.J).value;
  const SymmetricEigen<T> eigen = symmetric_eigen(right_cauchy_green(k.F));
  const T shift = eigenvalue_shift(k.J).value;
  T c[3];
  for (int a = 0; a < 3; ++a)
    c[a] = N::max(eigen.value[a] + shift, N::of(1e-6));
  T sum = N::of(0);
  for (const auto& term : terms_of(material))
  {
    T x[3];
    for (int a = 0; a < 3; ++a)
      x[a] = N::exp(N::of(0.5) * term.alpha * N::log(g * c[a]));
    const T most = N::max(x[0], N::max(x[1], x[2])), least = N::min(x[0], N::min(x[1], x[2]));
    const T mean = N::of(1.0 / 3.0) * (x[0] + x[1] + x[2]);
    sum =
        sum + N::max(term.mu * term.alpha, N::of(0)) * most + N::max(term.mu * (mean - least), term.mu * (mean - most));
  }
  return N::of(0.5) * sum / N::min(c[0], N::min(c[1], c[2]));
}

}  // namespace frontalis::physics
