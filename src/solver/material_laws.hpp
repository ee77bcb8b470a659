#pragma once

#include "frontalis/model/model.hpp"
#include "frontalis/physics/guccione.hpp"
#include "frontalis/physics/holzapfel.hpp"
#include "frontalis/physics/mooney_rivlin.hpp"
#include "frontalis/physics/ogden.hpp"

namespace frontalis
{

/// Calls visit(material, families...) with the law's struct filled from a material's parameters (their order: Law). A
/// law more is a case more. Neo-Hookean and the volumetric part, which every voxel has, are not laws of this list.
template <class T, class Visit>
FRONTALIS_LAW void visit_law(Law law, const T* p, Visit&& visit)
{
  switch (law)
  {
    case Law::mooney_rivlin:
      visit(physics::MooneyRivlin<T>{ p[0], p[2] });
      break;
    case Law::ogden:
      visit(physics::Ogden<T>{ { p[0], p[3] }, { p[2], p[4] } });
      break;
    case Law::fung:
      visit(physics::FungExponential<T>{ p[0], p[2] });
      break;
    case Law::holzapfel:
    {
      const physics::Vec3<T> families[2] = { { p[5], p[6], p[7] }, { p[8], p[9], p[10] } };
      visit(physics::HolzapfelGasserOgden<T>{ p[0], p[2], p[3], p[4] }, families);
      break;
    }
    case Law::guccione:
      visit(physics::Guccione<T>{ p[0], p[2], p[3], p[4] }, physics::Vec3<T>{ p[5], p[6], p[7] });
      break;
    case Law::neo_hookean:
      break;
  }
}

/// Adds weight times the law's first Piola-Kirchhoff stress to P.
template <class T>
FRONTALIS_LAW void add_law_stress(Law law, const T* parameters, const T& weight, const physics::Kinematics<T>& k,
                                  physics::Matrix3<T>& P)
{
  physics::Matrix3<T> own;
  for (auto& row : own.a)
    for (auto& x : row)
      x = physics::Number<T>::of(0);
  visit_law(law, parameters,
            [&](const auto& material, const auto&... families) { add_stress(material, k, families..., own); });
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      P.a[i][j] = P.a[i][j] + weight * own.a[i][j];
}

/// Bound of the law's tangent shear stiffness [Pa] at a deformation, for the time step.
template <class T>
FRONTALIS_LAW T law_stiffness(Law law, const T* parameters, const physics::Kinematics<T>& k)
{
  T stiffness = physics::Number<T>::of(0);
  visit_law(law, parameters,
            [&](const auto& material, const auto&... families)
            { stiffness = tangent_stiffness(material, k, families...); });
  return stiffness;
}

/// What a law adds to the bound of a voxel's stiffness since rest [N/m]. per_tangent: LawPart's.
template <class T>
FRONTALIS_LAW T law_stiffening(Law law, const T* parameters, const T& at_rest, const T& per_tangent,
                               const physics::Kinematics<T>& k)
{
  using N = physics::Number<T>;
  return per_tangent * N::max(law_stiffness(law, parameters, k) - at_rest, N::of(0));
}

}  // namespace frontalis
