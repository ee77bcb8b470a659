#pragma once

#include "frontalis/physics/element/fibres.hpp"
#include "frontalis/physics/materials/neo_hookean.hpp"
#include "frontalis/physics/time_step.hpp"
#include "frontalis/physics/viscosity.hpp"

namespace frontalis
{
namespace physics
{

// The stress of one voxel at one point, from all its effects. `Voxel` is a type of the backend that reads the data of a
// voxel from where the backend stores it. All moduli and weights that it returns are multiplied by the tissue volume,
// so that stresses are in N m. T is its number type: double, float or a SIMD batch of voxels. Each function of this
// folder calls some of the following members of `Voxel`:
//
//   scale(), stretch_weight(), stretch_half_sum(), hourglass_weight()   geometry, as in kinematics(),
//                                       voxel_stiffness_now() and hourglass_forces()
//   material()                          NeoHookean<T>
//   hourglass()                         scalar hourglass stiffness [N/m]
//   stabilisation()                     AssumedStrain<T>, used only if assumed_strain()
//   assumed_strain(), selective_reduced()   whether these replace scalar hourglass control
//   bound_at_rest()                     bound of the stiffness at rest [N/m]
//   has_laws(), each_law(visit)         laws beyond neo-Hookean: add_stress(k, P), stiffening(k), energy(k)
//   each_fibre(visit)                   Fibre<T, S> of each muscle for which has_stress() is true
//   viscous_terms(), viscous_term(n)    Prony series; ViscousTerm<T>
//   relaxed(n), keep_relaxed(n, H)      reads, stores one of its relaxed_tensors() stresses
//
// The following members decide whether an effect is computed at all, and whether its code is inlined. Each calls the
// function of the same name in this folder: add_laws(k, P), law_stiffening(k), add_fibres(k, P), add_viscosity(k, P),
// stiffness_now(k), gauss_forces(mode, with_bound, stiffness), scalar_hourglass(mode).

/// Adds the stress of the laws other than neo-Hookean.
template <class Voxel, class T>
FRONTALIS_LAW void add_laws(const Voxel& voxel, const Kinematics<T>& k, Matrix3<T>& P)
{
  voxel.each_law([&](const auto& law) { law.add_stress(k, P); });
}

/// First Piola-Kirchhoff stress of the elastic laws. `material`: the neo-Hookean material of the voxel, or that
/// material with only one of its two moduli.
template <class Voxel, class T>
FRONTALIS_LAW Matrix3<T> elastic_stress(const Voxel& voxel, const NeoHookean<T>& material, const Kinematics<T>& k)
{
  const IsotropicStress<T> isotropic = stress(material, k);
  Matrix3<T> P;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      P.a[i][j] = isotropic.on_gradient * k.F.a[i][j] + isotropic.on_cofactor * k.cofactor.a[i][j];
  if (voxel.has_laws())
    voxel.add_laws(k, P);
  return P;
}

/// Isochoric part of elastic_stress().
template <class Voxel, class T>
FRONTALIS_LAW Matrix3<T> isochoric_stress(const Voxel& voxel, const Kinematics<T>& k)
{
  NeoHookean<T> material = voxel.material();
  material.kappa = Number<T>::of(0);
  return elastic_stress(voxel, material, k);
}

/// Volumetric part of elastic_stress().
template <class T>
FRONTALIS_LAW Matrix3<T> volumetric_stress(const NeoHookean<T>& material, const Kinematics<T>& k)
{
  const T pressure = material.kappa * k.dilatation;
  Matrix3<T> P;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      P.a[i][j] = pressure * k.cofactor.a[i][j];
  return P;
}

/// Subtracts the part of the stress that has relaxed.
template <class Voxel, class T>
FRONTALIS_LAW void add_viscosity(const Voxel& voxel, const Kinematics<T>& k, Matrix3<T>& P)
{
  take_relaxed(k, voxel.relaxed(relaxed_tensors(voxel.viscous_terms()) - 1), P);
}

/// Increase of the stiffness bound since rest by the laws other than neo-Hookean [N/m].
template <class Voxel, class T>
FRONTALIS_LAW T law_stiffening(const Voxel& voxel, const Kinematics<T>& k)
{
  T sum = Number<T>::of(0);
  voxel.each_law([&](const auto& law) { sum = sum + law.stiffening(k); });
  return sum;
}

/// Bound of the largest eigenvalue of the voxel's stiffness [N/m]; NaN if the deformation is not finite.
template <class Voxel, class T>
FRONTALIS_LAW T stiffness_now(const Voxel& voxel, const Kinematics<T>& k)
{
  T now =
      voxel_stiffness_now(voxel.bound_at_rest(), voxel.material(), k, voxel.stretch_weight(), voxel.stretch_half_sum());
  if (voxel.has_laws())
    now = now + voxel.law_stiffening(k);
  return now;
}

}  // namespace physics
}  // namespace frontalis
