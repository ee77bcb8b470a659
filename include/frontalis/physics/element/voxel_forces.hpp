#pragma once

#include "frontalis/physics/assumed_strain.hpp"
#include "frontalis/physics/element/voxel_stress.hpp"
#include "frontalis/physics/hourglass.hpp"
#include "frontalis/physics/selective_reduced.hpp"

namespace frontalis
{
namespace physics
{

/// Replaces transformed displacements by the forces of the isochoric stress at eight Gauss points. If `with_bound` is
/// set, `stiffness` is raised to the largest bound at these points.
template <class Voxel, class T>
FRONTALIS_LAW void gauss_forces(const Voxel& voxel, T (&mode)[3][8], bool with_bound, T& stiffness)
{
  T force[3][8];
  for (auto& component : force)
    for (T& f : component)
      f = Number<T>::of(0);
  // The loop is unrolled so that the weights are constants.
  FRONTALIS_UNROLL
  for (int point = 0; point < 8; ++point)
  {
    T moved[3][8];
    at_gauss_point(point, mode, moved);
    const Kinematics<T> k = kinematics(moved[0], moved[1], moved[2], voxel.scale());
    add_gauss_forces(point, isochoric_stress(voxel, k), voxel.scale(), force);
    if (with_bound)
      stiffness = larger_or_none(stiffness, voxel.stiffness_now(k));
  }
  for (int c = 0; c < 3; ++c)
    for (int m = 0; m < 8; ++m)
      mode[c][m] = force[c][m];
}

/// Scalar hourglass control: replaces the hourglass modes of one component by the forces on them.
template <class T>
FRONTALIS_LAW void scalar_hourglass(const T& stiffness, T (&mode)[8])
{
  for (int m = 0; m < 8; ++m)
    if (is_hourglass_mode(m))
      mode[m] = stiffness * mode[m];
}

/// Stress of a voxel at its centre, from all its effects; each effect that changes the stress has its line here. Also
/// replaces the hourglass modes by the forces on them. A voxel with scalar hourglass control may instead call
/// scalar_hourglass() later, before stress_forces(), if one component at a time is faster. `stiffness` must be 0 before
/// the call; if `with_bound` is set, it becomes the bound of the largest eigenvalue of the present stiffness [N/m].
template <class Voxel, class T>
FRONTALIS_LAW Matrix3<T> element_stress(const Voxel& voxel, T (&mode)[3][8], bool with_bound, T& stiffness)
{
  const Kinematics<T> k = kinematics(mode[0], mode[1], mode[2], voxel.scale());
  const bool reduced = voxel.selective_reduced();
  Matrix3<T> P = reduced ? volumetric_stress(voxel.material(), k) : elastic_stress(voxel, voxel.material(), k);
  voxel.add_fibres(k, P);
  voxel.add_viscosity(k, P);
  if (with_bound && !reduced)
    stiffness = voxel.stiffness_now(k);
  if (voxel.assumed_strain())
    hourglass_forces(voxel.stabilisation(), voxel.hourglass(), voxel.hourglass_weight(), k.F, mode, P);
  else if (reduced)
    voxel.gauss_forces(mode, with_bound, stiffness);
  else
    voxel.scalar_hourglass(mode);
  return P;
}

/// Replaces the gradients of one component by the forces of the stress [N], after element_stress(). All modes are then
/// the forces conjugate to the transformed displacements.
template <class Voxel, class T>
FRONTALIS_LAW void stress_forces(const Voxel& voxel, const Matrix3<T>& P, int component, T (&mode)[8])
{
  mode[0] = Number<T>::of(0);
  for (int j = 0; j < 3; ++j)
  {
    const T force = P.a[component][j] * T(voxel.scale()[j]);
    T& to = mode[gradient_mode(j)];
    to = voxel.selective_reduced() ? to + force : force;
  }
}

}  // namespace physics
}  // namespace frontalis
