#pragma once

#include "frontalis/physics/neo_hookean.hpp"

namespace frontalis
{
namespace physics
{

/// Square of the highest frequency [1/s2] of a lone box voxel with one-point quadrature and lumped mass: an upper bound
/// for any assembly of such voxels (Irons & Treharne). With d_j = 1/h_j^2 the stress modes have
/// omega^2 = 4/rho eig(lambda sqrt(d) sqrt(d)^T + 2 mu diag(d)) <= 4/rho (lambda sum d + 2 mu max d), exact on cubes.
/// `along_fibre` [Pa] is stiffness that fibres add in one direction.
template <class T>
FRONTALIS_LAW T frequency_squared_bound(T mu, T kappa, T along_fibre, T density, T hx, T hy, T hz)
{
  using N = Number<T>;
  const T dx = N::of(1) / (hx * hx), dy = N::of(1) / (hy * hy), dz = N::of(1) / (hz * hz);
  const T largest = N::max(dx, N::max(dy, dz));
  const T lambda = kappa - N::of(2.0 / 3.0) * mu;
  return N::of(4) / density * (lambda * (dx + dy + dz) + (N::of(2) * mu + along_fibre) * largest);
}

/// How much a neo-Hookean element has stiffened by deformation, 1 at rest. The second derivatives of the energy
/// (physics/neo_hookean.hpp) are bounded term by term, the volumetric part's and the isochoric part's each by itself,
/// and what these bounds have grown since rest counts over the element's true stiffness at rest, kappa + mu (2 weight -
/// 2/3). weight[j] = (1/h_j^2) over the sum of the three.
template <class T, class S>
FRONTALIS_LAW T stiffening(const NeoHookean<T>& material, const Kinematics<T>& k, const S* weight)
{
  using N = Number<T>;
  T along = N::of(0);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      along = along + k.cofactor.a[i][j] * k.cofactor.a[i][j] * T(weight[j]);
  const T largest = N::max(T(weight[0]), N::max(T(weight[1]), T(weight[2])));
  // d2J = 2 F : cof dF, and |cof dF| is at most |dF|^2 / sqrt(3)
  const T turning = N::of(2 / 1.7320508075688772) * N::sqrt(k.I1) * largest;
  const T dilatation = N::max(k.J - N::of(1), N::of(1) - k.J);
  const T volumetric = along - N::of(1) + dilatation * turning;
  const IsochoricScale<T> g = isochoric_scale(k.J);
  const T bend = isochoric_bend(g, k.J);
  const T isochoric = N::of(0.5) * k.I1 * bend * along - N::of(2) * g.slope * N::sqrt(k.I1 * along * largest) +
                      N::of(2) * g.value * largest - N::of(0.5) * g.slope * k.I1 * turning;
  // the same at F = 1: I1 = 3, cof F = 1, g' = -2/3
  const T at_rest = N::of(5.0 / 3) + N::of(4.0 / 3) * N::sqrt(N::of(3) * largest) + N::of(4) * largest;
  const T stiffness = material.kappa + material.mu * (N::of(2) * largest - N::of(2.0 / 3));
  return N::of(1) + (material.kappa * volumetric + material.mu * N::max(isochoric - at_rest, N::of(0))) /
                        N::max(stiffness, N::of(1e-30));
}

}  // namespace physics
}  // namespace frontalis
