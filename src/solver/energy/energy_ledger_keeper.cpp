#include "solver/energy/energy_ledger_keeper.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{

EnergyLedgerKeeper::EnergyLedgerKeeper(const Model& model, const Discretisation& discretisation,
                                       const Conditions& conditions, StepBackend& backend)
    : model_(model),
      discretisation_(discretisation),
      conditions_(conditions),
      backend_(backend),
      loads_(model, discretisation),
      driven_(model.nodes.size(), { { false, false, false } })
{
  for (const auto& prescribed : model.prescribed)
    for (int axis = 0; axis < 3; ++axis)
      driven_[prescribed.node][axis] = driven_[prescribed.node][axis] || model.loads[prescribed.load].fixed[axis];
  for (const auto& rigid : model.rigid)
    driven_[rigid.node] = { { true, true, true } };
}

void EnergyLedgerKeeper::open(double time, double dt)
{
  backend_.work(true);
  NodalVectors none;
  backend_.contact_energy(true, none);
  ledger_ = {};
  const EnergyLedger now = balance(time, dt);
  ledger_.initial =
      now.kinetic + now.internal + now.hourglass + now.contact_stored - now.gravity - now.load - now.constraint;
}

EnergyLedger EnergyLedgerKeeper::balance(double time, double dt)
{
  EnergyLedger& l = ledger_;
  const Work latest = latest_half_step(time, dt);
  const Monitor stored = backend_.monitor();
  const Work noted = backend_.work(false);
  l.internal = stored.internal;
  l.hourglass = stored.hourglass;
  l.viscous = noted.viscous;
  l.damping = noted.damping;
  l.friction = noted.friction + latest.friction;
  l.muscle = noted.muscle;
  l.load = noted.load + latest.load;
  l.constraint = noted.constraint + noted.friction + latest.constraint;
  for (const double term : { l.initial, l.kinetic, l.internal, l.hourglass, l.viscous, l.damping, l.friction, l.muscle,
                             l.load, l.gravity, l.contact, l.contact_stored, l.constraint })
    l.largest = std::max(l.largest, std::abs(term));
  return l;
}

// Surface loads, and the correction of gravity on nodes whose mass is scaled.
NodalVectors EnergyLedgerKeeper::external_forces(double time, const NodalVectors& u)
{
  NodalVectors forces(u.size());
  if (loads_.idle())
    return forces;
  std::vector<double> component[3];
  for (int axis = 0; axis < 3; ++axis)
    for (const auto& x : u)
      component[axis].push_back(x[axis]);
  const double* const pointers[3] = { component[0].data(), component[1].data(), component[2].data() };
  loads_.update(time, pointers);
  for (std::size_t l = 0; l < loads_.nodes().size(); ++l)
    forces[loads_.nodes()[l]] = loads_.forces()[l];
  return forces;
}

// The account ends at the time of the velocities, half a step before the displacements. The work of that half step is
// that of the present forces. Nodes that do not follow the forces keep their velocity, at the expense of constraints.
Work EnergyLedgerKeeper::latest_half_step(double time, double dt)
{
  EnergyLedger& l = ledger_;
  NodalVectors u, v, internal;
  backend_.get(NodalField::displacements, u);
  backend_.get(NodalField::velocities, v);
  backend_.internal_forces(nullptr, internal);
  NodalVectors touching(u.size());
  const ContactEnergy contact = backend_.contact_energy(false, touching);
  const NodalVectors external = external_forces(time, u);
  const physics::Kick<double> kick = conditions_.kick<double>(dt);
  const bool weighs = conditions_.running.has(Effect::gravity);
  Work work;
  work.friction = contact.lost;
  l.contact = contact.work;
  l.contact_stored = contact.stored;
  l.kinetic = l.gravity = 0;
  for (std::size_t n = 0; n < u.size(); ++n)
  {
    const double mass = discretisation_.node_mass[n];
    const double weight = mass * (discretisation_.weight_share.empty() ? 1.0 : double(discretisation_.weight_share[n]));
    for (int axis = 0; axis < 3; ++axis)
    {
      const double next = physics::kicked(kick, axis, v[n][axis], kick.gain / mass,
                                          internal[n][axis] - external[n][axis] - touching[n][axis]);
      l.kinetic += 0.5 * mass * v[n][axis] * (driven_[n][axis] ? v[n][axis] : next);
      const double pull = weighs ? model_.gravity[axis] : 0;
      l.gravity += weight * pull * u[n][axis];
      // surface loads alone, without the correction for mass scaling
      const double force = external[n][axis] - weight * pull + mass * conditions_.gravity[axis];
      work.load += 0.5 * dt * force * v[n][axis];
      work.constraint += driven_[n][axis] ? 0.5 * mass * v[n][axis] * (v[n][axis] - next) : 0;
    }
  }
  return work;
}

}  // namespace frontalis
