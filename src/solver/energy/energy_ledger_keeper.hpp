#pragma once

#include "solver/stepping/nodal_loads.hpp"
#include "solver/stepping/step_backend.hpp"

namespace frontalis
{

/// Keeps the energy ledger of a backend's motion: stored energies as they are now, work as the backend has noted it.
class EnergyLedgerKeeper
{
public:
  /// All of them must outlive it.
  EnergyLedgerKeeper(const Model& model, const Discretisation& discretisation, const Conditions& conditions,
                     StepBackend& backend);

  /// Begins anew with the present state.
  void open(double time, double dt);
  /// dt [s]: of the latest step, or of the next where there was none.
  EnergyLedger balance(double time, double dt);
  void effect_switched() { loads_.run(conditions_.running); }
  void list_allocations(AllocationList& list) const { loads_.list_allocations(list); }

  const EnergyLedger& latest() const { return ledger_; }
  void restore(const EnergyLedger& ledger) { ledger_ = ledger; }

private:
  NodalVectors external_forces(double time, const NodalVectors& u);
  Work latest_half_step(double time, double dt);

  const Model& model_;
  const Discretisation& discretisation_;
  const Conditions& conditions_;
  StepBackend& backend_;
  NodalLoads loads_;
  std::vector<std::array<bool, 3>> driven_;  // nodes that do not follow the forces along an axis
  EnergyLedger ledger_;
};

}  // namespace frontalis
