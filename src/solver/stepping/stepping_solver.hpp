#pragma once

#include "solver/stepping/discretisation.hpp"
#include "frontalis/byte_archive.hpp"
#include "solver/energy/energy_account.hpp"
#include "frontalis/solver/solver.hpp"
#include "solver/stepping/restricted_nodes.hpp"
#include "solver/skin/skin_values.hpp"

#include <memory>

namespace frontalis
{

/// Part of an advance in equal steps; activations and poses go linearly from begin to end over it.
struct StepPlan
{
  int steps = 0;
  double dt = 0;
  /// For how long forces change velocities in the first step [s], which may follow a longer or a shorter one:
  /// velocities stand half a step before displacements.
  double first_kick = 0;
  double time = 0;       ///< at its begin
  bool closely = false;  ///< frequency bounds are looked at in every step
  bool awaited = false;  ///< what is seen in this plan rules the next, not a later one
  double alarm = 0;      ///< frequency bound squared above which it does in any case [1/s2]
  Controls begin, end;   ///< activations are those of the muscles, not those asked for

  double fraction(int step) const { return (step + 1.0) / steps; }
  void activation(int step, float* out) const;
  ConstraintStep constraint_step(int step) const;
};

/// How far a motion has come, besides what its nodes and voxels do: copied as one into a snapshot and back.
struct Course
{
  double time_ = 0;
  double latest_step_ = 0;        // [s]
  double frequency_squared_ = 0;  // bound of the highest, as it is believed
  double latest_seen_ = 0;        // of it
  int wary_ = 0;                  // steps to be taken with care yet
  int restless_ = 0;              // the same, but for close looks
  double assembled_share_ = 1;    // of the assembled model over it
  std::int64_t assembled_at_step_ = 0;
  double assembled_at_frequency_ = 0;
  std::vector<float> assembled_at_activation_;
  std::int64_t assembled_good_for_ = 0;  // steps
  std::vector<std::array<double, 3>> assembled_mode_;
  bool failed_ = false;
  Controls controls_;
  std::vector<RigidTransform> bone_before_;  // an advance ago
  double bone_seconds_ = 0;                  // which took so long; 0: there was none
  std::vector<float> activation_;
  EnergyLedger ledger_;
  double initial_ = 0;

  void archive(ByteArchive& archive)
  {
    archive(time_)(latest_step_)(
        frequency_squared_)(latest_seen_)(wary_)(restless_)(assembled_share_)(assembled_at_step_);
    archive(assembled_at_frequency_)(assembled_at_activation_)(assembled_good_for_)(assembled_mode_);
    archive(failed_)(controls_.activation)(controls_.bone)(bone_before_)(bone_seconds_)(activation_)(ledger_)(initial_);
  }
};

/// What the backends on the host share: time, controls, the choice of the time step, equilibrium, energies.
class SteppingSolver : public Solver, private Course
{
public:
  using Vectors = std::vector<std::array<double, 3>>;

  /// State of nodes and voxels, in a backend's own form.
  struct Fields
  {
    virtual ~Fields() = default;
    virtual void archive(ByteArchive& archive) = 0;
  };

  SteppingSolver(std::shared_ptr<const Model> model, const SolverSettings& settings);

  void reset() override;
  void advance(double seconds, const Controls& target) override;
  void check(double seconds, const Controls& target) const override;
  Equilibrium settle(const Controls& target, double tolerance, double seconds,
                     const std::function<bool(const Equilibrium&)>& go_on) override;
  void save(std::unique_ptr<Snapshot>& to) override;
  void restore(const Snapshot& snapshot) override;
  std::string pack() override;
  void unpack(const std::string& bytes) override;
  int steps_a_check() const override { return 512; }
  void slow_down(double share) override;
  double time() const override { return time_; }
  double time_step() const override { return safe_time_step(); }
  const Controls& controls() const override { return controls_; }
  const std::vector<float>& activation() const override { return activation_; }
  EffectSet effects() const override { return effects_; }
  void switch_effect(Effect effect, bool on) override;
  std::vector<Allocation> allocations() const override;
  void skin_field(SkinField field, std::vector<float>& out) override;
  Monitor monitor() override;
  EnergyLedger ledger() override;
  Profile profile() const override { return profile_; }

protected:
  /// Runs the plan's steps; returns the largest frequency bound squared [1/s2] that was looked at in it: at its last
  /// step, or in all (StepPlan::closely). NaN where displacements are not finite. A backend that has not got it yet may
  /// return that of the plan before, below StepPlan::alarm.
  virtual double run(const StepPlan& plan) = 0;
  /// Most steps between two looks at how far the voxels have stiffened.
  virtual int steps_a_plan() const { return 32; }
  /// Steps between two looks at all displacements while it settles.
  virtual int steps_a_look() const { return steps_a_plan(); }
  virtual void rest() = 0;  ///< displacements and velocities to zero
  /// What a backend keeps of its motion for a snapshot; `to` may hold an earlier one of its own, for its memory.
  virtual void save_fields(std::unique_ptr<Fields>& to) const = 0;
  virtual void restore_fields(const Fields& from) = 0;
  virtual void velocities(Vectors& out) const = 0;
  /// Internal forces [N] at displacements that are not the state's.
  virtual void forces_at(const Vectors& displacements, Vectors& out);
  /// Largest eigenvalue [1/s2] of M^-1/2 K M^-1/2 at the present state without constraints, by power iteration from
  /// where the latest one ended.
  virtual double assembled_frequency_squared(int most_iterations);
  /// Loads and, where mass scaling is not uniform, what gravity is less on scaled nodes [N], at the present state.
  virtual void external_forces(Vectors& out);
  /// Energies and the worst voxel now.
  virtual Monitor measure();
  /// Opens an account of work, and what is in it; only called where the ledger is wanted.
  virtual void open_account();
  virtual Work work();

  /// After an effect was switched.
  virtual void effect_switched(Effect effect) = 0;
  virtual void list_allocations(AllocationList& list) const = 0;
  bool runs(Effect effect) const { return effects_.has(effect); }
  /// Whose memory fibres are: contraction's where the model has it.
  Effect effect_of_fibres() const;
  /// Activation of each muscle as its fibres feel it.
  std::vector<float> felt_activation() const;

  /// To be called after displacements were set from outside: time step and ledger begin anew.
  void displacements_were_set();
  /// The same for velocities.
  void velocities_were_set();

  /// Damped central difference: v = keep * v + gain * force / mass.
  double keep(double dt) const;
  double gain(double dt) const;
  /// Most simulated seconds between two renewals of the viscous stresses.
  double viscous_interval() const { return 0.005 * discretisation_.viscous_time_min; }
  /// By how much viscous stresses relax after each step [s], 0 in most: after the last, and when they have not for that
  /// long; while it settles, for good.
  std::vector<double> relaxations(const StepPlan& plan) const;

  std::shared_ptr<const Model> model_;
  Discretisation discretisation_;
  Profile profile_;
  bool wants_ledger_ = false;
  double damping_ = 0;     ///< mass-proportional [1/s]
  bool settling_ = false;  ///< viscous stresses are fully relaxed
  /// Gravity [m/s2] on the masses as they are scaled: uniform mass scaling changes no weight.
  std::array<double, 3> gravity_{};

private:
  double safe_time_step() const;
  double careful_time_step() const;
  double critical_frequency_squared() const;
  void set_gravity();
  double steady_step(const std::vector<RigidTransform>& to, double seconds) const;
  double jerk_of_bones(const std::vector<RigidTransform>& to, double seconds) const;
  void respond(const std::vector<float>& from, const std::vector<float>& to, double seconds);
  void renew_assembled_bound(const std::vector<float>& target);
  void expect_frequency(double squared);
  void watch(double squared, const StepPlan& plan);
  double rayleigh_quotient(const Vectors& u, const Vectors& f, const Vectors& u_now, const Vectors& f_now) const;
  double distance(const Vectors& a, const Vectors& b) const;
  void open_ledger();

  struct Motion;
  /// Whose motions it can take back, for messages too.
  std::string owner() const;

  EffectSet effects_;
  std::unique_ptr<SkinValues> skin_values_;  // from the first request on
  double forced_time_step_ = 0;
  double slow_share_ = 1;  // of the safe time step
};

/// Of the power iteration: what it begins with; how far nodes move for a product with K, large for float and small for
/// the curvature of the laws [m].
void random_mode(SteppingSolver::Vectors& mode);
double mode_amplitude(const Model& model);

/// Whether the eigenvalue is known: estimates are compared with the latest but one, whose product is to the same side.
class ModeSearch
{
public:
  bool settled(double now);

private:
  int iterations_ = 0;
  double seen_[2] = {};
};

/// Controls at rest: no activation, bones in place.
Controls rest_controls(const Model& model);

}  // namespace frontalis
