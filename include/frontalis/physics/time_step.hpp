#pragma once

#include "frontalis/physics/number.hpp"

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

/// How much the volumetric stiffness of an element has grown by deformation: sum cof_ij^2 d_j over its value at rest.
template <class T, class S>
FRONTALIS_LAW T stiffening(const Matrix3<T>& cofactor, const S* d)
{
  T sum = Number<T>::of(0);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      sum = sum + cofactor.a[i][j] * cofactor.a[i][j] * T(d[j]);
  return sum;
}

}  // namespace physics
}  // namespace frontalis
