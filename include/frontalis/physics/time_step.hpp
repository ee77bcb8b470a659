#pragma once

#include "frontalis/physics/materials/neo_hookean.hpp"

namespace frontalis
{
namespace physics
{

/// Bound of the largest eigenvalue [N/m] of the stiffness of a box voxel with one-point quadrature, at rest, for a
/// volume of tissue [m3]. With d_j = 1/h_j^2 its stress modes have the eigenvalues V/2 eig(lambda sqrt(d) sqrt(d)^T +
/// 2 mu diag(d)) <= V/2 (max(lambda, 0) sum d + 2 mu max d), exact on cubes if lambda is not negative. It is negative
/// where `mu` is a bound that counts taut fibres as if they ran in all directions. `along_fibre` [Pa] is stiffness that
/// fibres add in one direction.
///
/// The bounds of all voxels together limit the highest frequency of the model. With k_e >= the largest eigenvalue of
/// the stiffness K_e of voxel e, and lumped masses m_n,
///   x^T K x = sum_e x_e^T K_e x_e <= sum_e k_e |x_e|^2 = sum_n (sum of k_e over the voxels at n) |x_n|^2,
/// so that
///   omega^2 <= max_n (sum of k_e over the voxels at n) / m_n,
/// where only nodes that can move count: x_n = 0 at the others, and constraints on x can only lower the largest
/// Rayleigh quotient. This is the element eigenvalue inequality (Irons & Treharne 1971; Belytschko, Liu &
/// Moran, Nonlinear Finite Elements for Continua and Structures, chapter 6) with the mass of a node split among its
/// voxels in proportion to k_e. In a uniform block the bound is that of a lone voxel of mass m, 8 k / m.
template <class T>
FRONTALIS_LAW T voxel_stiffness(T mu, T kappa, T along_fibre, T volume, T hx, T hy, T hz)
{
  using N = Number<T>;
  const T dx = N::of(1) / (hx * hx), dy = N::of(1) / (hy * hy), dz = N::of(1) / (hz * hz);
  const T largest = N::max(dx, N::max(dy, dz));
  const T lambda = N::max(kappa - N::of(2.0 / 3.0) * mu, N::of(0));
  return N::of(0.5) * volume * (lambda * (dx + dy + dz) + (N::of(2) * mu + along_fibre) * largest);
}

/// The larger number; NaN if one of them is NaN or infinite.
template <class T>
FRONTALIS_LAW T larger_or_none(const T& a, const T& b)
{
  return Number<T>::max(a, b) + (a - a) + (b - b);
}

/// Bound of the largest eigenvalue [N/m] of a voxel's stiffness at a deformation, without the stiffening of laws other
/// than neo-Hookean; NaN if the deformation is not finite. `at_rest`: voxel_stiffness(); `material`: moduli times the
/// volume of tissue [N m]; weight[j]: 1/h_j^2 divided by the sum over the three axes; half_sum: half of that sum
/// [1/m2].
///
/// Second derivatives of the neo-Hookean energy (materials/neo_hookean.hpp) are bounded term by term, separately for
/// the volumetric and the isochoric part. The growth of these bounds since rest is added to the bound at rest. The
/// stiffness of fibres is bounded at any stretch (muscle_fibre.hpp) and does not grow.
template <class T, class S>
FRONTALIS_LAW T voxel_stiffness_now(T at_rest, const NeoHookean<T>& material, const Kinematics<T>& k, const S* weight,
                                    S half_sum)
{
  using N = Number<T>;
  T along = N::of(0);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      along = along + k.cofactor.a[i][j] * k.cofactor.a[i][j] * T(weight[j]);
  const T largest = N::max(T(weight[0]), N::max(T(weight[1]), T(weight[2])));
  // The second derivative of J is 2 F : cof dF, and |cof dF| is at most |dF|^2 / sqrt(3).
  const T turning = N::of(2 / 1.7320508075688772) * N::sqrt(k.I1) * largest;
  const T dilatation = N::max(k.J - N::of(1), N::of(1) - k.J);
  const T volumetric = along - N::of(1) + dilatation * turning;
  const IsochoricScale<T> g = isochoric_scale(k.J);
  const T bend = isochoric_bend(g, k.J);
  // Half of the second derivative of x = g I1 - 3, and its value at F = 1, where I1 = 3, cof F = 1 and g' = -2/3.
  const T isochoric = N::of(0.5) * k.I1 * bend * along - N::of(2) * g.slope * N::sqrt(k.I1 * along * largest) +
                      N::of(2) * g.value * largest - N::of(0.5) * g.slope * k.I1 * turning;
  const T isochoric_at_rest = N::of(5.0 / 3) + N::of(4.0 / 3) * N::sqrt(N::of(3) * largest) + N::of(4) * largest;
  T slope_squared = N::of(0);  // of x, weighted as `along`
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
    {
      const T slope = N::of(2) * g.value * k.F.a[i][j] + g.slope * k.I1 * k.cofactor.a[i][j];
      slope_squared = slope_squared + slope * slope * T(weight[j]);
    }
  const T secant = secant_modulus(material, g.value * k.I1);
  const T grown = material.kappa * volumetric + N::max(secant * isochoric - material.mu * isochoric_at_rest, N::of(0)) +
                  N::of(0.5) * material.mu * material.stiffening * slope_squared;
  return at_rest + T(half_sum) * N::max(grown, N::of(0)) + (grown - grown);
}

}  // namespace physics
}  // namespace frontalis
