#include "solver/energy/energy_ledger_keeper.hpp"

#include "solver/stepping/effect_parts.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{

double& EnergyLedger::operator[](const std::string& name)
{
  for (EnergyTerm& term : terms)
    if (term.name == name)
      return term.value;
  throw Error("no energy is called '" + name + "'");
}

double EnergyLedger::imbalance() const
{
  using Kind = EnergyTerm::Kind;
  double sum = 0;
  for (const Kind kind : { Kind::stored, Kind::lost, Kind::work })
    for (const EnergyTerm& term : terms)
      if (term.kind == kind)
        sum += kind == Kind::work ? -term.value : term.value;
  return sum - initial;
}

EnergyLedger empty_ledger()
{
  using Kind = EnergyTerm::Kind;
  EnergyLedger ledger;
  ledger.terms = {
    { "kinetic", Kind::stored },   // m v(n - 1/2) . v(n + 1/2) / 2, which central differences conserve
    { "internal", Kind::stored },  // elastic energy of the materials
    { "hourglass", Kind::stored }, { "viscous", Kind::lost },  // absorbed by viscous stresses
    { "damping", Kind::lost },     { "friction", Kind::lost },
    { "muscle", Kind::work },  // of fibres, active and passive
    { "load", Kind::work },    // of surface loads
    { "gravity", Kind::work },
  };
  for (const EnergyTerm& term : energy_terms_of_effects())
    ledger.terms.push_back(term);
  // work of bones, prescribed paths and sliding surfaces, without friction
  ledger.terms.push_back({ "constraint", Kind::work });
  return ledger;
}

EnergyLedgerKeeper::EnergyLedgerKeeper(const Model& model, const Discretisation& discretisation,
                                       const Conditions& conditions, StepBackend& backend)
    : model_(model),
      discretisation_(discretisation),
      conditions_(conditions),
      backend_(backend),
      loads_(model, discretisation),
      driven_(model.nodes.size(), { { false, false, false } }),
      ledger_(empty_ledger())
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
  ledger_ = empty_ledger();
  backend_.add_energies(true, none, ledger_);
  const EnergyLedger now = balance(time, dt);
  for (const EnergyTerm& term : now.terms)
    ledger_.initial += term.kind == EnergyTerm::Kind::stored ? term.value : 0;
  // The ledger starts at the time of the displacements, half a step after that of the velocities, so that the work
  // during this half step is subtracted.
  ledger_.initial = ledger_.initial - now["gravity"] - now["load"] - now["constraint"];
}

void EnergyLedgerKeeper::masses_changed(const std::vector<AddedMass>& changed)
{
  NodalVectors u, v;
  backend_.get(NodalField::displacements, u);
  backend_.get(NodalField::velocities, v);
  for (const AddedMass& mass : changed)
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      const double more = mass.now - mass.before, speed = v[mass.node][axis];
      ledger_.initial += 0.5 * more * speed * speed - more * pull_on(mass.node, axis) * u[mass.node][axis];
    }
}

double EnergyLedgerKeeper::pull_on(std::size_t node, std::size_t axis) const
{
  if (!conditions_.running.has(Effect::gravity))
    return 0;
  return model_.gravity[axis] *
         (discretisation_.weight_share.empty() ? 1.0 : double(discretisation_.weight_share[node]));
}

EnergyLedger EnergyLedgerKeeper::balance(double time, double dt)
{
  EnergyLedger& l = ledger_;
  for (EnergyTerm& term : l.terms)
    term.value = 0;
  add_latest_half_step(time, dt);
  const Monitor stored = backend_.monitor();
  const Work noted = backend_.work(false);
  l["internal"] = stored.internal;
  l["hourglass"] = stored.hourglass;
  l["viscous"] = noted.viscous;
  l["damping"] = noted.damping;
  l["friction"] += noted.friction;
  l["muscle"] = noted.muscle;
  l["load"] += noted.load;
  l["constraint"] += noted.constraint + noted.friction;
  l.largest = std::max(l.largest, std::abs(l.initial));
  for (const EnergyTerm& term : l.terms)
    l.largest = std::max(l.largest, std::abs(term.value));
  return l;
}

// Returns the forces [N] of surface loads and of the correction of gravity on nodes with scaled mass.
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
  loads_.update(time, conditions_.activation, pointers);
  for (std::size_t l = 0; l < loads_.nodes().size(); ++l)
    forces[loads_.nodes()[l]] = loads_.forces()[l];
  return forces;
}

// Adds the work of the latest half step: the account ends at the time of the velocities, which is half a step before
// that of the displacements. The present forces act during this half step. Nodes that bones or prescribed paths drive
// keep their velocity, so that constraints do the opposite of the forces' work there.
void EnergyLedgerKeeper::add_latest_half_step(double time, double dt)
{
  NodalVectors u, v, internal;
  backend_.get(NodalField::displacements, u);
  backend_.get(NodalField::velocities, v);
  backend_.internal_forces(internal);
  NodalVectors touching(u.size());
  backend_.add_energies(false, touching, ledger_);
  const NodalVectors external = external_forces(time, u);
  const physics::Kick<double> kick = conditions_.kick<double>(dt);
  double &kinetic = ledger_["kinetic"], &gravity = ledger_["gravity"], &load = ledger_["load"],
         &constraint = ledger_["constraint"];
  for (std::size_t n = 0; n < u.size(); ++n)
  {
    const double mass = discretisation_.node_mass[n];
    for (int axis = 0; axis < 3; ++axis)
    {
      const double next = physics::kicked(kick, axis, v[n][axis], kick.gain / mass,
                                          internal[n][axis] - external[n][axis] - touching[n][axis]);
      kinetic += 0.5 * mass * v[n][axis] * (driven_[n][axis] ? v[n][axis] : next);
      const double weight = mass * pull_on(n, axis);
      gravity += weight * u[n][axis];
      // Force of surface loads alone, without the correction for mass scaling.
      const double force = external[n][axis] - weight + mass * conditions_.gravity[axis];
      load += 0.5 * dt * force * v[n][axis];
      constraint += driven_[n][axis] ? 0.5 * mass * v[n][axis] * (v[n][axis] - next) : 0;
    }
  }
}

}  // namespace frontalis
