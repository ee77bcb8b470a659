#pragma once

#include "frontalis/solver/rigid_motion.hpp"
#include "frontalis/solver/solver.hpp"

namespace frontalis
{

/// Forces of tissue on bones at one moment, in the local frame. Nodes count by Solver::internal_forces().
struct BoneForces
{
  using Vector = physics::Vec3<double>;

  BoneForces(Solver& solver, const Model& model);

  /// Adds a force [N] and its moment [N m] about the point of the bone that rests at the origin of the local frame.
  /// Forces on bone -1, which stands still, are left out.
  void add(std::int32_t bone, const Vector& force, const Vector& moment);
  /// Adds a force that acts at a point [m].
  void add_at(std::int32_t bone, const Vector& at, const Vector& force);

  RigidTransform pose_of(std::int32_t bone) const;
  std::array<double, 3> rest_of(std::int32_t node) const
  {
    return rest_position(model, static_cast<std::size_t>(node));
  }
  Vector place_of(std::int32_t node) const;  ///< present position [m]
  Vector force_of(std::int32_t node) const;  ///< of the tissue on what carries the node [N]
  /// The normal of a constraint surface at a present point; zero where its field has no samples or too short a
  /// gradient.
  Vector normal_at(const ConstraintSurface& surface, const Vector& at) const;

  const Model& model;
  const EffectSet effects;
  const std::vector<RigidTransform>& pose;  ///< per bone
  std::vector<Reaction> sum;                ///< per bone

private:
  std::vector<std::array<double, 3>> internal_, displaced_;
};

/// The part of a force on a node that a surface carries: the whole component along its unit normal, and as much of the
/// tangential component as friction can hold. Where there is no normal (zero), the surface carries the whole force, as
/// it would in equilibrium.
BoneForces::Vector carried(const BoneForces::Vector& normal, double friction, const BoneForces::Vector& force);

/// Adds the forces of nodes that slide on surfaces of bones.
void add_sliding_nodes(BoneForces& bones);
/// Adds the forces of nodes that are attached at true boundaries.
void add_attached_nodes(BoneForces& bones);

}  // namespace frontalis
