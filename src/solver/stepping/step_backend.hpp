#pragma once

#include "frontalis/byte_archive.hpp"
#include "solver/energy/energy_account.hpp"
#include "solver/stepping/added_mass.hpp"
#include "solver/stepping/array_list.hpp"
#include "solver/stepping/discretisation.hpp"
#include "solver/stepping/step_plan.hpp"

#include <memory>
#include <string>

namespace frontalis
{

/// One vector per node, in the order of Model::nodes.
using NodalVectors = std::vector<std::array<double, 3>>;

enum class NodalField
{
  displacements,  ///< [m]
  velocities      ///< [m/s], half a step before the displacements
};

/// The state of a motion between two plans, in the backend's own form.
struct BackendState
{
  virtual ~BackendState() = default;
  virtual void archive(ByteArchive& archive) = 0;
};

/// Description of a backend, and its preferred numbers of steps.
struct BackendTraits
{
  std::string description;  ///< backend, number type, instruction set or device, threads
  /// A plan lasts this long [s], unless the next two values limit its number of steps.
  double seconds_per_plan = 0;
  int fewest_steps_per_plan = 32;
  int most_steps_per_plan = 32;
  int steps_per_observation = 32;  ///< steps between two evaluations of all displacements during dynamic relaxation
  int steps_per_check = 512;       ///< Solver::steps_per_check
};

/// What a backend measures in a plan.
struct PlanMeasures
{
  double frequency_squared = 0;  ///< largest bound of a squared frequency [1/s2]; NaN if displacements are not finite
  double speed = 0;              ///< largest speed of a node after the last step [m/s]
};

/// Data that a time stepper shares with its backend.
struct BackendInput
{
  const Model& model;
  const Discretisation& discretisation;
  const Conditions& conditions;
  const SolverSettings& settings;  ///< the only member that need not outlive the backend
};

/// Makes time steps of a model whose nodes and voxels it keeps in its own memory, initially at rest. TimeStepper makes
/// a Solver of it.
class StepBackend
{
public:
  virtual ~StepBackend() = default;

  virtual BackendTraits traits() const = 0;
  virtual void list_arrays(ArrayList& list) = 0;

  /// Runs the plan's steps. If the plan allows it, the measures may be those of the previous plan.
  virtual PlanMeasures run(const StepPlan& plan) = 0;
  /// Called after Conditions::running and the bounds have changed. Effects that are switched on again start without
  /// history.
  virtual void effects_switched() = 0;

  virtual void get(NodalField field, NodalVectors& out) const = 0;
  /// Sets a field of all nodes; an empty list stands for zeros. Setting displacements resets all other state to rest.
  virtual void set(NodalField field, const NodalVectors& in) = 0;
  /// Saves the state in `to`. If `to` holds an earlier state of this backend, its memory is reused.
  virtual void save(std::unique_ptr<BackendState>& to) = 0;
  virtual void restore(const BackendState& from) = 0;

  /// Internal forces [N] at the present displacements.
  virtual void internal_forces(NodalVectors& out) = 0;
  /// Squared highest frequency [1/s2] of the assembled model at the present displacements and activations; see
  /// highest_frequency_search.hpp.
  virtual double highest_frequency_squared() = 0;
  /// From now on, plans and monitor() measure how much the model can have stiffened since the present displacements: a
  /// node's bound counts times found / (its bound now), where that is below 1, until displacements are set. `found`:
  /// the squared highest frequency [1/s2], or infinity, which ends this. `keeps`: whether a smaller factor of earlier
  /// calls remains. Called in assembled models only.
  virtual void measure_growth(double found, bool keeps) = 0;
  /// The modes above a squared frequency [1/s2] that the latest search met. Called only if
  /// MassScalingSettings::in_motion is set.
  virtual std::vector<FoundMode> modes_above(double frequency_squared) = 0;
  /// Called after masses of these nodes have changed in the discretisation. What plans measure may follow them at the
  /// next measure_growth() only.
  virtual void masses_changed(const std::vector<std::int32_t>& nodes) = 0;
  virtual Monitor monitor() = 0;
  /// Work since the energy account was opened; with `open`, the account is opened now. Called only if
  /// SolverSettings::ledger is set.
  virtual Work work(bool open) = 0;
  /// See NodePart::add_energies.
  virtual void add_energies(bool /*open*/, NodalVectors& /*forces*/, EnergyLedger& /*ledger*/) {}
  virtual std::vector<Reaction> reactions() const { return {}; }
  /// Values of Monitor::lost_points and Monitor::bodies.
  virtual std::int64_t lost_points() const { return 0; }
  virtual double body_energy() const { return 0; }
  /// Present poses of the bodies of reactions(). The pose of a pushed body differs from its bone's.
  virtual std::vector<RigidTransform> bodies() const { return {}; }
  virtual void skin(SkinState& out) = 0;

protected:
  explicit StepBackend(const BackendInput& input)
      : model_(&input.model), discretisation_(input.discretisation), conditions_(input.conditions)
  {
  }
  bool runs(Effect effect) const { return conditions_.running.has(effect); }

  const Model* const model_;
  const Discretisation& discretisation_;
  const Conditions& conditions_;
};

}  // namespace frontalis
