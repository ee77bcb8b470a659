#pragma once

#include "solver/stepping/assembled_estimate.hpp"
#include "solver/stepping/step_backend.hpp"

namespace frontalis
{

/// Chooses the length of steps, and how many of them are taken until the frequency bound is looked at again. It sees
/// nothing but the bounds that are observed, activations, and what it is told of bones.
///
/// Just below the critical step, what stiffens as it vibrates gains or loses energy in every swing. So after signs of
/// fast change it is cautious for some steps: they are shorter, plans are short, and every step is looked at. Of what
/// merely vibrates, stiff as it has become, steps are shorter and plans at most 32 steps long.
class TimeStepController
{
public:
  struct State
  {
    double frequency_squared = 0;  ///< bound at nodes that is gone by [1/s2]
    double latest_observed = 0;    ///< latest bound [1/s2]
    int cautious_steps_left = 0;
    int vibration_steps_left = 0;
    AssembledEstimate assembled;

    void archive(ByteArchive& archive)
    {
      archive(frequency_squared)(latest_observed)(cautious_steps_left)(vibration_steps_left);
      assembled.archive(archive);
    }
  };
  /// The next plan.
  struct Choice
  {
    int steps;
    double dt;              ///< [s]
    bool reaches_end;       ///< of the motion
    bool bound_every_step;  ///< as in StepPlan
    bool bound_awaited;     ///< as in StepPlan
  };

  /// `safety_share`: of the critical step that is taken; `fixed_step` [s]: taken instead, 0: none. Throws Error where
  /// that is above the critical step at rest.
  TimeStepController(double rest_frequency_squared, double safety_share, double fixed_step);

  /// Largest step [s] that would be taken now if nothing called for caution.
  double safe_step() const;
  /// At most this share of the safe step is taken from now on. Throws Error.
  void slow_down(double share);
  /// Bound above which a plan's own bound has to be awaited [1/s2].
  double alarming_frequency_squared() const;
  /// For a motion that ends after `remaining` [s]; steps are no longer than `longest` [s].
  Choice choose(double remaining, double longest, const BackendTraits& backend) const;

  /// After a plan: the largest bound that was found in it, or in the one before.
  void observe(double frequency_squared, int steps);
  /// Whether muscles are switched between these activations: they stiffen their voxels, and so does a little later what
  /// they draw.
  bool muscles_switched(const std::vector<float>& from, const std::vector<float>& to);
  void bone_jumped();
  /// Displacements were set from outside, where the bound at nodes is this [1/s2].
  void displacements_set(double frequency_squared);
  /// The bound at rest has another value now, because effects were switched.
  void set_rest_frequency(double squared) { rest_frequency_squared_ = squared; }
  /// Back to rest.
  void reset();

  const State& state() const { return state_; }
  void restore(const State& state) { state_ = state; }
  AssembledEstimate& assembled() { return state_.assembled; }

private:
  double critical_step(double share) const;  ///< a share of it

  double rest_frequency_squared_, safety_share_, fixed_step_;
  double slow_share_ = 1;
  State state_;
};

}  // namespace frontalis
