#pragma once

#include "frontalis/physics/element/node_motion.hpp"
#include "frontalis/solver/reaction.hpp"
#include "frontalis/solver/solver_state.hpp"
#include "solver/energy/energy_account.hpp"
#include "solver/stepping/array_list.hpp"
#include "solver/stepping/constraint_step.hpp"

#include <array>
#include <vector>

namespace frontalis
{

/// The planes of nodes that one thread processes.
struct NodeShare
{
  int thread, threads;
  std::int32_t first_plane, end_plane;
  std::int32_t first_node, end_node;
};

/// Applies external forces to nodes. Either subtracts them from internal forces, or corrects nodes that were already
/// updated; the correction is exact, because the update is linear in the force.
template <class Real>
class ForceSink
{
public:
  /// Makes a sink that subtracts forces from internal forces [N].
  explicit ForceSink(Real* const internal[3]) : u_{ internal[0], internal[1], internal[2] } {}
  /// Makes a sink that corrects displacements [m] and velocities [m/s]. `gain`: that of a physics::Kick.
  ForceSink(Real gain, Real dt, const float* inverse_mass, Real* const u[3], Real* const v[3])
      : gain_(gain), dt_(dt), inverse_mass_(inverse_mass), u_{ u[0], u[1], u[2] }, v_{ v[0], v[1], v[2] }
  {
  }
  template <class Number = double>
  void operator()(std::int32_t node, const std::array<Number, 3>& force) const
  {
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (inverse_mass_ == nullptr)
        u_[axis][node] -= static_cast<Real>(force[axis]);
      else
        physics::add_load(gain_ * inverse_mass_[node], dt_, static_cast<Real>(force[axis]), u_[axis][node],
                          v_[axis][node]);
  }

private:
  Real gain_ = 0, dt_ = 0;
  const float* inverse_mass_ = nullptr;
  Real* u_[3];
  Real* v_[3] = {};
};

/// The part of a host backend that computes an effect on nodes. In each step, each thread calls these functions in the
/// order of their declaration, for its own nodes. By default they do nothing. Real is the backend's number type.
template <class Real>
class NodePart : public EffectPart
{
public:
  /// Whether the part has nothing to do. If so, none of the other functions is called.
  virtual bool idle() const = 0;
  /// Whether prepare_step() does anything. If so, threads wait for each other between prepare_step() and before_step().
  virtual bool prepares() const { return false; }
  /// Whether add_forces() adds forces. If so, threads wait for each other between before_step() and add_forces().
  virtual bool pushes() const { return false; }
  /// Called after Discretisation::node_mass has changed.
  virtual void masses_changed() {}
  /// The next two functions are called with the displacements at the start of the step.
  virtual void prepare_step(const NodeShare& /*share*/, const Real* const /*u*/[3]) {}
  virtual void before_step(const NodeShare& /*share*/, const Real* const /*u*/[3], const ConstraintStep& /*step*/) {}
  virtual void add_forces(const NodeShare& /*share*/, const ForceSink<Real>& /*sink*/) {}
  /// Overwrites displacements and velocities after the update. `before`: displacements before the update.
  virtual void constrain(const NodeShare& /*share*/, Real* const /*u*/[3], Real* const /*v*/[3],
                         const Real* const /*before*/[3], const ConstraintStep& /*step*/)
  {
  }
  /// Whether constrain_groups() is needed. If so, threads wait for each other before and after it.
  virtual bool groups() const { return false; }
  /// Overwrites displacements and velocities of groups of nodes, which may belong to several threads. One thread
  /// processes each group.
  virtual void constrain_groups(const NodeShare& /*share*/, Real* const /*u*/[3], Real* const /*v*/[3],
                                const ConstraintStep& /*step*/)
  {
  }
  /// Called with the displacements before and after the step.
  virtual void after_step(const NodeShare& /*share*/, const Real* const /*before*/[3], const Real* const /*after*/[3])
  {
  }
  /// Adds the effect's work in the step. `kick`: time over which forces changed velocities [s].
  virtual void account(const NodeShare& /*share*/, EnergyAccount<Real>& /*account*/, const Real* const /*v*/[3],
                       double /*kick*/)
  {
  }

  /// Adds the effect's present energies to terms of the ledger. Also adds the present forces [N] to `forces`, unless
  /// that is empty. `open`: works and losses count from now on. `bones`: present poses.
  virtual void add_energies(const Real* const /*u*/[3], const std::vector<RigidTransform>& /*bones*/, bool /*open*/,
                            std::vector<std::array<double, 3>>& /*forces*/, EnergyLedger& /*ledger*/)
  {
  }
  /// Reactions of the latest step, one per entry of touched_bodies(model) that belongs to this effect.
  virtual std::vector<Reaction> reactions() const { return {}; }
  /// Present poses of the bodies of reactions(), from those of the bones.
  virtual std::vector<RigidTransform> bodies(const std::vector<RigidTransform>& /*bones*/) const { return {}; }
  /// Values of Monitor::lost_points and Monitor::bodies.
  virtual std::int64_t lost_points() const { return 0; }
  virtual double body_energy() const { return 0; }
};

}  // namespace frontalis
