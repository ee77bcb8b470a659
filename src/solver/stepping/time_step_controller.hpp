#pragma once

#include "solver/stepping/assembled_estimate.hpp"
#include "solver/stepping/step_backend.hpp"

namespace frontalis
{

/// Chooses the length of steps, and the number of steps until the frequency bound is found again, from the bounds that
/// a backend finds, the activations, and jumps of bones.
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
    double frequency_squared = 0;  ///< bound at nodes from which steps are chosen [1/s2]
    double latest_observed = 0;    ///< bound that the estimate covered in the latest plan [1/s2]
    int cautious_steps_left = 0;
    int vibration_steps_left = 0;
    AssembledEstimate assembled;

    void archive(ByteArchive& archive)
    {
      archive(frequency_squared)(latest_observed)(cautious_steps_left)(vibration_steps_left);
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

  /// Steps take `safety_share` of the critical step, or `fixed_step` [s] if that is not 0. Throws Error if the fixed
  /// step is above the critical one at rest.
  TimeStepController(double rest_frequency_squared, double safety_share, double fixed_step);

  /// Longest step [s] that would be made now without caution.
  double safe_step() const;
  /// Limits further steps to this fraction of the safe step. Throws Error if it is out of range.
  void slow_down(double share);
  /// Bound above which the backend must wait for a plan's own bound [1/s2]; see StepPlan.
  double alarming_frequency_squared() const;
  /// The next plan of a motion that ends after `remaining` [s], with steps of at most `longest` [s].
  Choice choose(double remaining, double longest, const BackendTraits& backend) const;

  /// Records the largest bound that a backend found in the latest plan or in the plan before it.
  void observe(double frequency_squared, int steps);
  /// Whether a muscle is switched on or off between these activations. If so, the controller becomes cautious, because
  /// the muscle's voxels stiffen at once, and the voxels that it pulls stiffen a little later.
  bool muscles_switched(const std::vector<float>& from, const std::vector<float>& to);
  /// Becomes cautious, because the velocity of a bone has jumped (BoneMotionLimits).
  void bone_jumped();
  /// Resets the controller after displacements were set from outside. `frequency_squared`: bound of the model's squared
  /// frequencies at these displacements [1/s2].
  void displacements_set(double frequency_squared);
  /// Sets the bound at rest [1/s2], which changes when effects are switched.
  void set_rest_frequency(double squared) { rest_frequency_squared_ = squared; }
  void reset();

  const State& state() const { return state_; }
  void restore(const State& state) { state_ = state; }
  AssembledEstimate& assembled() { return state_.assembled; }

private:
  double critical_step(double share) const;  ///< this fraction of the critical step [s]

  double rest_frequency_squared_, safety_share_, fixed_step_;
  double slow_share_ = 1;
  State state_;
};

}  // namespace frontalis
