#pragma once

#include "solver/energy/energy_ledger_keeper.hpp"
#include "solver/skin/skin_values.hpp"
#include "solver/stepping/added_mass.hpp"
#include "solver/stepping/bone_motion_limits.hpp"
#include "solver/stepping/effect_switches.hpp"
#include "solver/stepping/time_step_controller.hpp"

#include <algorithm>
#include <functional>

namespace frontalis
{

/// The Solver of every backend: divides a motion into plans of equal steps and has the backend run them.
class TimeStepper final : public Solver
{
public:
  using MakeBackend = std::function<std::unique_ptr<StepBackend>(const BackendInput&)>;

  /// Throws Error like make_solver().
  TimeStepper(std::shared_ptr<const Model> model, const SolverSettings& settings, const MakeBackend& make_backend);

  void reset() override;
  bool advance(double seconds, const Controls& target, const std::function<bool()>& go_on = {}) override;
  void check(double seconds, const Controls& target) const override;
  Equilibrium settle(const Controls& target, double tolerance, double seconds,
                     const std::function<bool(const Equilibrium&)>& go_on) override;
  void save(std::unique_ptr<Snapshot>& to) override;
  void restore(const Snapshot& snapshot) override;
  std::string pack() override;
  void unpack(const std::string& bytes) override;
  int steps_per_check() const override { return traits_.steps_per_check; }
  void set_damping(double damping);  ///< frontalis/solver/damping.hpp
  void slow_down(double share) override { controller_.slow_down(share); }
  double time() const override { return motion_.time; }
  double time_step() const override { return std::min(controller_.safe_step(), longest_step()); }
  const Controls& controls() const override { return motion_.controls; }
  const std::vector<float>& activation() const override { return motion_.activation; }
  EffectSet effects() const override { return effects_.running(); }
  void switch_effect(Effect effect, bool on) override;
  std::vector<Allocation> allocations() const override;
  void skin(SkinState& out) override { backend_->skin(out); }
  void skin_field(SkinField field, std::vector<float>& out) override;
  Monitor monitor() override;
  EnergyLedger ledger() override;
  std::vector<Reaction> reactions() const override { return backend_->reactions(); }
  std::vector<RigidTransform> bodies() const override { return backend_->bodies(); }
  Profile profile() const override { return profile_; }
  void displacements(NodalVectors& out) const override { backend_->get(NodalField::displacements, out); }
  void set_displacements(const NodalVectors& in) override;
  void set_velocities(const NodalVectors& in) override;
  void internal_forces(NodalVectors& out) override;
  std::string description() const override { return traits_.description; }

private:
  /// State of the motion, without that of controller, ledger and backend.
  struct Motion
  {
    BoneMotionLimits bones;
    Controls controls;
    std::vector<float> activation;
    std::vector<AddedMass> added;
    double time = 0;         // [s]
    double changed = 0;      // latest time at which poses or activations changed [s]
    double latest_step = 0;  // [s]; 0: no step has been made
    bool diverged = false;

    void archive(ByteArchive& archive)
    {
      bones.archive(archive);
      archive(controls.activation)(controls.bone)(activation)(added)(time)(changed)(latest_step)(diverged);
    }
  };
  struct MotionSnapshot;

  Motion at_rest() const;
  void renew_conditions();
  /// Longest step [s] that stiffness added by effects allows whatever the frequency; infinite without such a limit.
  double longest_step() const;
  /// Longest duration of a plan [s] in a motion that reaches `target` after `seconds`; infinite without a limit.
  double longest_plan(const Controls& target, double seconds) const;
  double shortest_edge() const;  // of a voxel [m]
  void renew_assembled_estimate(const Controls& asked);
  /// Squared highest frequency [1/s2] at these activations, after mass has been added where that is wanted.
  double search_frequency(const std::vector<float>& activation);
  /// Tells the other parts that masses of the discretisation have changed.
  void masses_changed(const std::vector<AddedMass>& changed);
  /// Gives nodes the masses that motion_ says, instead of those that were added before.
  void replace_masses(const std::vector<AddedMass>& before);
  StepPlan plan_to(const Controls& next, const TimeStepController::Choice& choice);
  void effects_switched(const std::vector<Effect>& effects);
  bool slides() const;
  void check_sliding_nodes() const;
  /// Resets the choice of the time step and opens the ledger again.
  void displacements_were_set();
  void open_ledger();
  double ledger_step() const;
  std::string owner() const;

  std::shared_ptr<const Model> model_;
  Discretisation discretisation_;
  EffectSwitches effects_;
  Conditions conditions_;
  TimeStepController controller_;
  std::unique_ptr<StepBackend> backend_;
  BackendTraits traits_;
  std::unique_ptr<EnergyLedgerKeeper> ledger_;  // null without a ledger
  std::unique_ptr<SkinValues> skin_values_;     // made on the first request
  MassInMotion mass_in_motion_;
  Motion motion_;
  Profile profile_;
  double damping_;         // outside of settle() [1/s]
  bool settling_ = false;  // viscous stresses are fully relaxed, and no ledger is kept
};

}  // namespace frontalis
