#pragma once

#include "frontalis/physics/laminate.hpp"
#include "solver/material_laws.hpp"

namespace frontalis
{

/// The part of a voxel that has one law other than neo-Hookean, in the form that physics/element/ reads.
template <class T>
struct LawShare
{
  Law law;
  T weight;                                ///< fraction of the voxel's tissue, times tissue volume [m3]
  T at_rest;                               ///< tangent stiffness at rest [Pa]
  T per_tangent;                           ///< LawPart::per_tangent [m]
  T parameters[physics::parameter_slots];  ///< ordered as in physics/materials/description.hpp

  FRONTALIS_LAW void add_stress(const physics::Kinematics<T>& k, physics::Matrix3<T>& P) const
  {
    add_law_stress(law, parameters, weight, k, P);
  }
  FRONTALIS_LAW T stiffening(const physics::Kinematics<T>& k) const
  {
    return law_stiffening(law, parameters, at_rest, per_tangent, k);
  }
  /// Energy [J]; 0 in lanes of a batch whose voxels do not have the law, whatever parameters these lanes contain.
  FRONTALIS_LAW T energy(const physics::Kinematics<T>& k) const
  {
    using N = physics::Number<T>;
    T sum = N::of(0);
    visit_law(law, parameters,
              [&](const auto& material, const auto&... families)
              { sum = N::select(weight > N::of(0), weight * physics::energy(material, k, families...), N::of(0)); });
    return sum;
  }
};

/// The sheet of a laminate, in the same form. Its parameters are in the slots of a material's: see sheet_part().
template <class T>
struct SheetShare
{
  const LawShare<T>& share;

  FRONTALIS_LAW physics::Sheet<T> sheet() const
  {
    const T* const p = share.parameters;
    const T* const n = p + physics::first_direction;
    return { share.weight * p[0], share.weight * p[physics::slot_of(1)], { n[0], n[1], n[2] } };
  }
  FRONTALIS_LAW void add_stress(const physics::Kinematics<T>& k, physics::Matrix3<T>& P) const
  {
    physics::add_stress(sheet(), k, P);
  }
  FRONTALIS_LAW T stiffening(const physics::Kinematics<T>& k) const
  {
    using N = physics::Number<T>;
    const T* const p = share.parameters;
    const physics::Sheet<T> unit{ p[0], p[physics::slot_of(1)], sheet().normal };
    return share.per_tangent * N::max(physics::tangent_stiffness(unit, k) - share.at_rest, N::of(0));
  }
  FRONTALIS_LAW T energy(const physics::Kinematics<T>& k) const { return physics::energy(sheet(), k); }
};

/// Calls visit() with the law as LawShare or SheetShare.
template <class T, class Visit>
FRONTALIS_LAW void visit_share(const LawShare<T>& share, Visit&& visit)
{
  if (share.law == physics::sheet_law)
    visit(SheetShare<T>{ share });
  else
    visit(share);
}

}  // namespace frontalis
