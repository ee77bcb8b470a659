#pragma once

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

}  // namespace frontalis
