#pragma once

#include "frontalis/physics/number.hpp"

namespace frontalis
{
namespace physics
{

/// Assumed-strain hourglass control of a box voxel: the ASQBI field of Belytschko & Bindeman (1993, Comput. Methods
/// Appl. Mech. Eng. 105:225). Each axis has its own bending stiffness, Poisson's ratio couples the two bendings of a
/// plate, and the shear modulus resists torsion.
///
/// The hourglass modes q are pulled back by the deformation gradient, r = F^T q, so that the stiffness rotates with the
/// element. The energy 1/2 r K r does not change in a rotation, and the forces are its complete gradient, so that
/// energy and angular momentum are conserved. A small part of the scalar hourglass stiffness is added, which also
/// controls crushed elements, whose F^T q is small.
template <class T>
struct AssumedStrain
{
  T bending;   ///< 2 mu / (1 - nu) times tissue volume [N m]
  T coupling;  ///< 2 mu nu / (1 - nu) times tissue volume [N m]
  T torsion;   ///< mu times tissue volume [N m]
  T warping;   ///< 2 mu (1 + nu) / 3 times tissue volume [N m]
};

/// Fraction of the scalar hourglass stiffness that is added to assumed-strain control.
constexpr double assumed_strain_floor = 0.02;

template <class T>
FRONTALIS_LAW AssumedStrain<T> assumed_strain(T mu, T kappa, T tissue_volume)
{
  using N = Number<T>;
  const T nu = (N::of(3) * kappa - N::of(2) * mu) / (N::of(6) * kappa + N::of(2) * mu);
  const T twice = N::of(2) * mu * tissue_volume;
  const T bending = twice / (N::of(1) - nu);
  return { bending, nu * bending, mu * tissue_volume, twice * (N::of(1) + nu) * N::of(1.0 / 3) };
}

/// Index, among the transformed displacements, of the hourglass mode yz, xz, xy or xyz (pair 0, 1, 2 or 3).
FRONTALIS_LAW constexpr int paired_mode(int pair) { return pair == 0 ? 6 : pair == 1 ? 5 : pair == 2 ? 3 : 7; }

/// Two normal strains vary along the same axis. `own` is the bending stiffness of each, E / (1 - n^2), and `coupled`
/// the stiffness between the two, n E / (1 - n^2). Here n is Poisson's ratio times the squared ratio of the shortest
/// edge to the edge along that axis; for an axis with the shortest edge, these are the values of a plate.
template <class T>
struct AxisBending
{
  T own;
  T coupled;
};

template <class T, class S>
FRONTALIS_LAW AxisBending<T> axis_bending(const AssumedStrain<T>& k, const S* weight, int axis)
{
  using N = Number<T>;
  const S other = weight[(axis + 1) % 3] > weight[(axis + 2) % 3] ? weight[(axis + 1) % 3] : weight[(axis + 2) % 3];
  if (!(weight[axis] < other))
    return { k.bending, k.coupling };
  const S ratio = weight[axis] / other;
  // The lower limit avoids 0 / 0 in a SIMD lane that has no voxel.
  const T n = T(ratio * ratio) * k.coupling / N::max(k.bending, N::of(1e-30));
  // E times tissue volume is three times the warping stiffness.
  const T own = N::of(3) * k.warping / (N::of(1) - n * n);
  return { own, n * own };
}

/// Forces conjugate to the pulled-back modes r[pair][axis]; force[pair][axis] has the same order. With weight[i] = 1 /
/// (4 sqrt(3) h_i), the volume integrals of products of mode derivatives are products of two weights, for modes of
/// amplitude 8.
template <class T, class S>
FRONTALIS_LAW void hourglass_forces(const AssumedStrain<T>& k, const S* weight, const T (&r)[4][3], T (&force)[4][3])
{
  const AxisBending<T> along[3] = { axis_bending(k, weight, 0), axis_bending(k, weight, 1),
                                    axis_bending(k, weight, 2) };
  for (int i = 0; i < 3; ++i)
  {
    const int j = (i + 1) % 3, l = (i + 2) % 3;
    const T wi(weight[i]), wj(weight[j]), wl(weight[l]);
    // Displacement u_i in the mode that does not vary along i: torsion, and its coupling to the other two modes.
    force[i][i] = k.torsion * (((wj * wj) + (wl * wl)) * r[i][i] + wi * (wj * r[j][j] + wl * r[l][l]));
    // Displacement u_i in the modes paired with j and l: bending along i, coupled to bending along j and l.
    force[j][i] = wi * (along[l].own * wi * r[j][i] + along[l].coupled * wj * r[i][j]);
    force[l][i] = wi * (along[j].own * wi * r[l][i] + along[j].coupled * wl * r[i][l]);
    force[3][i] = k.warping * wi * wi * r[3][i];
  }
}

/// Replaces the hourglass modes of the transformed displacements q[axis][mode] by the forces conjugate to them, and
/// adds the force conjugate to F_ij to Q[i][j] [N m]. scalar: hourglass_stiffness times assumed_strain_floor [N/m].
template <class T, class S>
FRONTALIS_LAW void hourglass_forces(const AssumedStrain<T>& k, const T& scalar, const S* weight, const Matrix3<T>& F,
                                    T (&q)[3][8], Matrix3<T>& Q)
{
  T r[4][3], conjugate[4][3];
  for (int pair = 0; pair < 4; ++pair)
    for (int j = 0; j < 3; ++j)
      r[pair][j] = F.a[0][j] * q[0][paired_mode(pair)] + F.a[1][j] * q[1][paired_mode(pair)] +
                   F.a[2][j] * q[2][paired_mode(pair)];
  hourglass_forces(k, weight, r, conjugate);
  for (int pair = 0; pair < 4; ++pair)
    for (int i = 0; i < 3; ++i)
    {
      T& mode = q[i][paired_mode(pair)];
      for (int j = 0; j < 3; ++j)
        Q.a[i][j] = Q.a[i][j] + mode * conjugate[pair][j];
      mode = scalar * mode + F.a[i][0] * conjugate[pair][0] + F.a[i][1] * conjugate[pair][1] +
             F.a[i][2] * conjugate[pair][2];
    }
}

/// Energy of the hourglass modes of the transformed displacements q[axis][mode] [J].
template <class T, class S>
FRONTALIS_LAW T hourglass_energy(const AssumedStrain<T>& k, const T& scalar, const S* weight, const Matrix3<T>& F,
                                 const T (&q)[3][8])
{
  T r[4][3], conjugate[4][3], sum = Number<T>::of(0);
  for (int pair = 0; pair < 4; ++pair)
    for (int j = 0; j < 3; ++j)
    {
      r[pair][j] = F.a[0][j] * q[0][paired_mode(pair)] + F.a[1][j] * q[1][paired_mode(pair)] +
                   F.a[2][j] * q[2][paired_mode(pair)];
      sum = sum + scalar * q[j][paired_mode(pair)] * q[j][paired_mode(pair)];
    }
  hourglass_forces(k, weight, r, conjugate);
  for (int pair = 0; pair < 4; ++pair)
    for (int j = 0; j < 3; ++j)
      sum = sum + r[pair][j] * conjugate[pair][j];
  return Number<T>::of(0.5) * sum;
}

}  // namespace physics
}  // namespace frontalis
