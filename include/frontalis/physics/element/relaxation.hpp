#pragma once

#include "frontalis/physics/element/voxel_stress.hpp"

namespace frontalis
{
namespace physics
{

/// One term of a voxel's Prony series for viscosity.
template <class T>
struct ViscousTerm
{
  T share;  ///< fraction of the isochoric stress that relaxes
  T rate;   ///< 1 / relaxation time [1/s]
};

/// Relaxes the viscous stresses of a voxel by `elapsed` [s] towards those at k (physics/viscosity.hpp). Calls
/// renewed(before, after) with the relaxed stress of each term.
template <class Voxel, class T, class Renewed>
FRONTALIS_LAW void relax_voxel(const Voxel& voxel, const T& elapsed, const Kinematics<T>& k, Renewed&& renewed)
{
  using N = Number<T>;
  const Symmetric3<T> S = second_piola(k, isochoric_stress(voxel, k));
  const int terms = voxel.viscous_terms();
  Symmetric3<T> sum;
  for (T& component : sum.a)
    component = N::of(0);
  for (int n = 0; n < terms; ++n)
  {
    Symmetric3<T> H = voxel.relaxed(n);
    const Symmetric3<T> before = H;
    const ViscousTerm<T> term = voxel.viscous_term(n);
    relax(term.share, N::exp(-term.rate * elapsed), S, H);
    voxel.keep_relaxed(n, H);
    for (int i = 0; i < 6; ++i)
      sum.a[i] = sum.a[i] + H.a[i];
    renewed(before, H);
  }
  if (terms == 2)
    voxel.keep_relaxed(2, sum);
}

}  // namespace physics
}  // namespace frontalis
