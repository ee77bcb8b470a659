#pragma once

#include "frontalis/physics/materials/all.hpp"

namespace frontalis
{

/// Calls visit(solid) or visit(solid, directions) with the law's struct, filled from a material's numbers. The
/// neo-Hookean law and the volumetric part are left out, because every voxel has them and kernels compute them
/// separately.
template <class T, class Visit>
FRONTALIS_LAW void visit_law(Law law, const T* numbers, Visit&& visit)
{
  physics::visit_table<1>(law, numbers, visit);
}

/// Adds weight times the law's first Piola-Kirchhoff stress to P.
template <class T>
FRONTALIS_LAW void add_law_stress(Law law, const T* numbers, const T& weight, const physics::Kinematics<T>& k,
                                  physics::Matrix3<T>& P)
{
  physics::Matrix3<T> own;
  for (auto& row : own.a)
    for (auto& x : row)
      x = physics::Number<T>::of(0);
  visit_law(law, numbers,
            [&](const auto& solid, const auto&... directions) { add_stress(solid, k, directions..., own); });
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      P.a[i][j] = P.a[i][j] + weight * own.a[i][j];
}

/// Bound of the law's tangent shear stiffness [Pa] at a deformation, for the time step.
template <class T>
FRONTALIS_LAW T law_stiffness(Law law, const T* numbers, const physics::Kinematics<T>& k)
{
  T stiffness = physics::Number<T>::of(0);
  visit_law(law, numbers,
            [&](const auto& solid, const auto&... directions)
            { stiffness = tangent_stiffness(solid, k, directions...); });
  return stiffness;
}

/// Increase of a voxel's stiffness bound over that at rest, by one law [N/m]; see LawPart::per_tangent.
template <class T>
FRONTALIS_LAW T law_stiffening(Law law, const T* numbers, const T& at_rest, const T& per_tangent,
                               const physics::Kinematics<T>& k)
{
  using N = physics::Number<T>;
  return per_tangent * N::max(law_stiffness(law, numbers, k) - at_rest, N::of(0));
}

}  // namespace frontalis
