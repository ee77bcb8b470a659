#pragma once

#include "solver/stepping/assembled_estimate.hpp"
#include "solver/stepping/step_backend.hpp"

namespace frontalis
{

/// Chooses the length of steps, and the number of steps until the backend measures again, from what a backend measures,
/// the activations, and jumps of bones. A backend measures the bound of the squared frequency at nodes or, if the
/// highest frequency of the assembled model sets the time step, how much this can have grown since the latest search
/// (AssembledEstimate) [1/s2]. It also measures how fast nodes move: a node that moves far in a step may crush a voxel,
/// whose stiffness then grows before it is measured.
///
/// Just below the critical step, tissue that stiffens as it vibrates gains or loses energy in every cycle. The
/// controller is therefore cautious for some steps after signs of fast change: steps are shorter, plans have few steps,
/// and the bound is found in every step. While stiffened tissue vibrates, steps are shorter and the length of plans is
/// limited.
class TimeStepController
{
public:
  struct State
  {
    double measured = 0;         ///< from which steps are chosen [1/s2]
    double latest_measured = 0;  ///< in the latest plan [1/s2]
    double latest_covered = 0;   ///< squared frequency that was covered in the latest plan [1/s2]
    double speed = 0;            ///< largest of a node, in shortest voxel edges [1/s]
    int cautious_steps_left = 0;
    int vibration_steps_left = 0;
    AssembledEstimate assembled;

    void archive(ByteArchive& archive)
    {
      archive(measured)(latest_measured)(latest_covered)(speed)(cautious_steps_left)(vibration_steps_left);
      assembled.archive(archive);
    }
  };
  /// Properties of the next plan.
  struct Choice
  {
    int steps;
    double dt;              ///< [s]
    bool reaches_end;       ///< whether the plan reaches the end of the motion
    bool bound_every_step;  ///< as in StepPlan
    bool bound_awaited;     ///< as in StepPlan
  };

  /// Steps take `safety_share` of the critical step, or `fixed_step` [s] if that is not 0. `bound_at_rest`: of the
  /// squared frequency at nodes [1/s2]. Throws Error if the fixed step is above the critical one at rest.
  TimeStepController(double bound_at_rest, TimeStepEstimate estimate, double safety_share, double fixed_step);

  /// Longest step [s] that would be made now without caution.
  double safe_step() const;
  /// Limits further steps to this fraction of the safe step. Throws Error if it is out of range.
  void slow_down(double share);
  /// Critical step if a backend measures this [s].
  double critical_step_at(double measured) const;
  /// What the backend must measure in a plan before to wait for what it measures in the plan itself; see StepPlan.
  double alarming() const;
  /// The next plan, of at most `longest_plan` [s], of a motion that ends after `remaining` [s], with steps of at most
  /// `longest` [s].
  Choice choose(double remaining, double longest, double longest_plan, const BackendTraits& backend) const;

  /// Records the most that a backend measured in the latest plan or in the plan before it. `speed`: as in State.
  void observe(double measured, double speed, int steps);
  /// Records the speed after velocities were set from outside.
  void velocities_set(double speed) { state_.speed = speed; }
  /// Whether a muscle is switched on or off between these activations. If so, the controller becomes cautious, because
  /// the muscle's voxels stiffen at once, and the voxels that it pulls stiffen a little later.
  bool muscles_switched(const std::vector<float>& from, const std::vector<float>& to);
  /// Becomes cautious, because the velocity of a bone has jumped (BoneMotionLimits).
  void bone_jumped();
  /// Resets the controller, but for the speed, after displacements were set from outside. `measured`: by the backend at
  /// these.
  void displacements_set(double measured);
  /// Sets the bound at rest [1/s2], which changes when effects are switched.
  void set_bound_at_rest(double squared);
  /// Searches for the highest frequency of the assembled model if this is due (AssembledEstimate::renew()).
  AssembledEstimate::Renewal renew_assembled(const std::vector<float>& activation, bool moving,
                                             const AssembledEstimate::Search& search);
  void reset();

  const State& state() const { return state_; }
  void restore(const State& state) { state_ = state; }

private:
  double critical_step(double share) const;  ///< this fraction of the critical step [s]
  double cautious_step() const;              ///< [s]
  int steps_after_stiffening() const;        ///< number of cautious steps
  double covered(double measured) const;     ///< squared frequency for which steps are chosen at a measure [1/s2]
  double measured_at_rest() const { return state_.assembled.known() ? 0 : bound_at_rest_; }

  double bound_at_rest_, safety_share_, fixed_step_;
  bool assembled_;
  double slow_share_ = 1;
  State state_;
};

}  // namespace frontalis
