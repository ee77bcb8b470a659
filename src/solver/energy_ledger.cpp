#include "frontalis/error.hpp"
#include "stepping_solver.hpp"

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
  initial_ = now.kinetic + now.internal + now.hourglass - now.gravity;
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

  // velocities half a step on, but of nodes that do not follow the forces
  std::vector<bool> driven(model_->nodes.size(), false);
  for (const auto& rigid : model_->rigid)
    driven[rigid.node] = true;
  for (const auto& prescribed : model_->prescribed)
    driven[prescribed.node] = true;
  const double dt = latest_step_ > 0 ? latest_step_ : safe_time_step();
  l.kinetic = l.gravity = 0;
  for (std::size_t n = 0; n < u.size(); ++n)
  {
    const double mass = discretisation_.node_mass[n];
    const double weight = mass * (discretisation_.weight_share.empty() ? 1.0 : double(discretisation_.weight_share[n]));
    for (int axis = 0; axis < 3; ++axis)
    {
      const double acceleration = gravity_[axis] + (external[n][axis] - internal[n][axis]) / mass;
      const double next = driven[n] ? v[n][axis] : keep(dt) * v[n][axis] + gain(dt) * acceleration;
      l.kinetic += 0.5 * mass * v[n][axis] * next;
      if (runs(Effect::gravity))
        l.gravity += weight * model_->gravity[axis] * u[n][axis];
    }
  }

  const Work done = work();
  l.viscous = done.viscous;
  l.damping = done.damping;
  l.friction = done.friction;
  l.muscle = done.muscle;
  l.load = done.load;
  l.constraint = done.constraint + done.friction;
  for (const double term : { l.initial, l.kinetic, l.internal, l.hourglass, l.viscous, l.damping, l.friction, l.muscle,
                             l.load, l.gravity, l.constraint })
    l.largest = std::max(l.largest, std::abs(term));
  profile_.monitor += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return l;
}

}  // namespace frontalis
