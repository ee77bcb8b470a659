#pragma once

#include "frontalis/physics/isochoric.hpp"
#include "frontalis/physics/voxel_element.hpp"

namespace frontalis
{
namespace physics
{

/// Symmetric tensor: xx, yy, zz, xy, yz, zx.
template <class T>
struct Symmetric3
{
  T a[6];
};

FRONTALIS_LAW constexpr int symmetric_row(int i) { return i < 3 ? i : i - 3; }
FRONTALIS_LAW constexpr int symmetric_column(int i) { return i < 3 ? i : (i - 2) % 3; }

/// Second Piola-Kirchhoff stress S = F^-1 P = (cof F)^T P / J. The divisor is kept above continuation_jacobian.
template <class T>
FRONTALIS_LAW Symmetric3<T> second_piola(const Kinematics<T>& k, const Matrix3<T>& P)
{
  using N = Number<T>;
  const T inverse = N::of(1) / N::max(k.J, N::of(continuation_jacobian));
  Symmetric3<T> S;
  for (int n = 0; n < 6; ++n)
  {
    const int i = symmetric_row(n), j = symmetric_column(n);
    S.a[n] =
        inverse * (k.cofactor.a[0][i] * P.a[0][j] + k.cofactor.a[1][i] * P.a[1][j] + k.cofactor.a[2][i] * P.a[2][j]);
  }
  return S;
}

/// One term of a Prony series on the isochoric stress (Taylor et al. 2009, Med. Image Anal. 13:234). The relaxed part H
/// of the stress follows dH/dt = (share S - H) / time, solved exactly here for a constant S over a time `elapsed`;
/// decay = exp(-elapsed / time). The stress in the body is S - H.
template <class T>
FRONTALIS_LAW void relax(const T& share, const T& decay, const Symmetric3<T>& S, Symmetric3<T>& H)
{
  const T gain = (Number<T>::of(1) - decay) * share;
  for (int n = 0; n < 6; ++n)
    H.a[n] = decay * H.a[n] + gain * S.a[n];
}

/// Number of tensors stored per voxel: one per term. Two terms also store their sum, which is all that a step reads.
FRONTALIS_LAW constexpr int relaxed_tensors(int terms) { return terms == 2 ? 3 : terms; }

/// Subtracts the relaxed stress: P -= F H.
template <class T>
FRONTALIS_LAW void take_relaxed(const Kinematics<T>& k, const Symmetric3<T>& H, Matrix3<T>& P)
{
  const auto& h = H.a;
  for (int i = 0; i < 3; ++i)
  {
    const auto& f = k.F.a[i];
    P.a[i][0] = P.a[i][0] - (f[0] * h[0] + f[1] * h[3] + f[2] * h[5]);
    P.a[i][1] = P.a[i][1] - (f[0] * h[3] + f[1] * h[1] + f[2] * h[4]);
    P.a[i][2] = P.a[i][2] - (f[0] * h[5] + f[1] * h[4] + f[2] * h[2]);
  }
}

/// The product H : E with the Green-Lagrange strain E = (F^T F - 1) / 2.
template <class T>
FRONTALIS_LAW T along_strain(const Kinematics<T>& k, const Symmetric3<T>& H)
{
  using N = Number<T>;
  T sum = N::of(0);
  for (int n = 0; n < 6; ++n)
  {
    const int i = symmetric_row(n), j = symmetric_column(n);
    const T c = k.F.a[0][i] * k.F.a[0][j] + k.F.a[1][i] * k.F.a[1][j] + k.F.a[2][i] * k.F.a[2][j];
    sum = sum + (n < 3 ? N::of(0.5) * (c - N::of(1)) : c) * H.a[n];
  }
  return sum;
}

/// Change of H : E, at constant strain, when the relaxed stress H changes from `before` to `after` at the end of a
/// step. (The rest of the change of H : E is the work against H, the sum of H : dE.) A stress does work along the mean
/// of the motions before and after it, so that the strain here is the mean of the strains at the start and at the end
/// of the step.
template <class T>
FRONTALIS_LAW T relaxation_work(const Kinematics<T>& begin, const Kinematics<T>& end, const Symmetric3<T>& before,
                                const Symmetric3<T>& after)
{
  Symmetric3<T> change;
  for (int n = 0; n < 6; ++n)
    change.a[n] = after.a[n] - before.a[n];
  return Number<T>::of(0.5) * (along_strain(begin, change) + along_strain(end, change));
}

}  // namespace physics
}  // namespace frontalis
