#include "frontalis/error.hpp"
#include "solver/stepping/stepping_solver.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace frontalis
{

void SteppingSolver::open_account() { throw Error("backend " + description() + " keeps no energy ledger"); }

Work SteppingSolver::work() { return {}; }

void SteppingSolver::external_forces(Vectors& out) { out.assign(model_->nodes.size(), {}); }

void SteppingSolver::open_ledger()
{
  open_account();
  ledger_ = {};
  initial_ = 0;
  const EnergyLedger now = ledger();
  initial_ = now.kinetic + now.internal + now.hourglass - now.gravity - now.load - now.constraint;
}

EnergyLedger SteppingSolver::ledger()
{
  if (!wants_ledger_)
    throw Error("no energy ledger is kept: ask for it in SolverSettings");
  const auto start = std::chrono::steady_clock::now();
  EnergyLedger& l = ledger_;
  Vectors u, v, internal, external;
  displacements(u);
  velocities(v);
  internal_forces(internal);
  external_forces(external);
  const Monitor state = measure();
  l.initial = initial_;
  l.internal = state.internal;
  l.hourglass = state.hourglass;

  // The account ends half a step before the displacements, where the velocities are: the work since then is that of the
  // present forces. Nodes that do not follow the forces keep their velocity, by what constraints add to it.
  std::vector<std::array<bool, 3>> driven(model_->nodes.size(), { { false, false, false } });
  for (const auto& prescribed : model_->prescribed)
    for (int axis = 0; axis < 3; ++axis)
      driven[prescribed.node][axis] = driven[prescribed.node][axis] || model_->loads[prescribed.load].fixed[axis];
  for (const auto& rigid : model_->rigid)
    driven[rigid.node] = { { true, true, true } };
  const double dt = latest_step_ > 0 ? latest_step_ : safe_time_step();
  const bool weights = runs(Effect::gravity);
  double load = 0, constraint = 0;
  l.kinetic = l.gravity = 0;
  for (std::size_t n = 0; n < u.size(); ++n)
  {
    const double mass = discretisation_.node_mass[n];
    const double weight = mass * (discretisation_.weight_share.empty() ? 1.0 : double(discretisation_.weight_share[n]));
    for (int axis = 0; axis < 3; ++axis)
    {
      const double acceleration = gravity_[axis] + (external[n][axis] - internal[n][axis]) / mass;
      const double next = keep(dt) * v[n][axis] + gain(dt) * acceleration;
      l.kinetic += 0.5 * mass * v[n][axis] * (driven[n][axis] ? v[n][axis] : next);
      const double pull = weights ? model_->gravity[axis] : 0;
      l.gravity += weight * pull * u[n][axis];
      // without what mass scaling takes off
      const double force = external[n][axis] - weight * pull + mass * gravity_[axis];
      load += 0.5 * dt * force * v[n][axis];
      constraint += driven[n][axis] ? 0.5 * mass * v[n][axis] * (v[n][axis] - next) : 0;
    }
  }

  const Work done = work();
  l.viscous = done.viscous;
  l.damping = done.damping;
  l.friction = done.friction;
  l.muscle = done.muscle;
  l.load = done.load + load;
  l.constraint = done.constraint + done.friction + constraint;
  for (const double term : { l.initial, l.kinetic, l.internal, l.hourglass, l.viscous, l.damping, l.friction, l.muscle,
                             l.load, l.gravity, l.constraint })
    l.largest = std::max(l.largest, std::abs(term));
  profile_.monitor += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return l;
}

}  // namespace frontalis
