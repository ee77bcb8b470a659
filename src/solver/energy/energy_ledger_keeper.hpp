#pragma once

#include "solver/stepping/nodal_loads.hpp"
#include "solver/stepping/added_mass.hpp"
#include "solver/stepping/step_backend.hpp"

namespace frontalis
{

/// A ledger with all its terms, which have the value 0.
EnergyLedger empty_ledger();

/// Keeps the energy ledger of a backend's motion: present stored energies, and the work that the backend recorded.
class EnergyLedgerKeeper
{
public:
  /// All arguments must outlive this object.
  EnergyLedgerKeeper(const Model& model, const Discretisation& discretisation, const Conditions& conditions,
                     StepBackend& backend);

  /// Starts a new ledger at the present state.
  void open(double time, double dt);
  /// Finds the present energies. `dt` [s]: length of the latest step, or of the next step if no step has been made.
  EnergyLedger balance(double time, double dt);
  void effects_switched() { loads_.run(conditions_.running); }
  void list_arrays(ArrayList& list) { loads_.list_arrays(list); }

  const EnergyLedger& latest() const { return ledger_; }
  void restore(const EnergyLedger& ledger) { ledger_ = ledger; }
  /// Called when masses have changed, with velocities as they were. The kinetic energy that comes or goes with the mass
  /// counts as if it had done so when the ledger was opened.
  void masses_changed(const std::vector<AddedMass>& changed);

private:
  /// Acceleration [m/s2] with which gravity acts on a node's mass.
  double pull_on(std::size_t node, std::size_t axis) const;
  NodalVectors external_forces(double time, const NodalVectors& u);
  void add_latest_half_step(double time, double dt);

  const Model& model_;
  const Discretisation& discretisation_;
  const Conditions& conditions_;
  StepBackend& backend_;
  NodalLoads<double> loads_;
  std::vector<std::array<bool, 3>> driven_;  // axes along which a node does not follow the forces
  EnergyLedger ledger_;
};

}  // namespace frontalis
