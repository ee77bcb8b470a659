#pragma once

#include "frontalis/physics/element/node_motion.hpp"
#include "frontalis/solver/rigid_motion.hpp"
#include "frontalis/solver/solver.hpp"
#include "solver/stepping/constraint_step.hpp"

namespace frontalis
{

/// Inputs of steps that are not part of a plan. The time stepper changes them between two plans, and backends read
/// them.
struct Conditions
{
  EffectSet running;
  std::array<double, 3> gravity{};   ///< acceleration for the scaled masses [m/s2]; 0 if the effect is off
  double damping = 0;                ///< mass-proportional [1/s]
  std::vector<float> activation;     ///< present activation of each muscle as it acts (EffectSwitches::felt)
  std::vector<RigidTransform> bone;  ///< present poses

  template <class Real>
  physics::Kick<Real> kick(double seconds) const
  {
    return physics::kick_of<Real>(damping, seconds, gravity);
  }
};

/// A part of a motion in equal steps, over which activations and bone poses change linearly from `begin` to `end`.
struct StepPlan
{
  int steps = 0;
  double dt = 0;  ///< [s]
  /// Duration for which forces change velocities in the first step [s]. Velocities belong to the middle of a step, so
  /// that this is half of the previous step plus half of dt.
  double first_kick = 0;
  double time = 0;                ///< time at the start of the plan [s]
  bool bound_every_step = false;  ///< true: measure the frequency bound in every step; false: in the last one only
  bool bound_awaited = false;     ///< true: run() must return the measures of this plan, not of the previous one
  double alarming = 0;            ///< run() waits for the measures of this plan if the previous bound was higher [1/s2]
  Controls begin, end;            ///< activations as fibres feel them
  std::vector<double> relaxation;  ///< one per step: by how much viscous stresses relax after it [s]

  double fraction(int step) const { return (step + 1.0) / steps; }
  void activation(int step, float* out) const
  {
    const auto f = static_cast<float>(fraction(step));
    for (std::size_t m = 0; m < begin.activation.size(); ++m)
      out[m] = begin.activation[m] + f * (end.activation[m] - begin.activation[m]);
  }
  /// Poses of the bones at the end of a step; those at the start of the plan for step -1.
  std::vector<RigidTransform> bones(int step) const
  {
    std::vector<RigidTransform> at = end.bone;
    for (std::size_t b = 0; b < at.size(); ++b)
      at[b] = interpolate(begin.bone[b], end.bone[b], fraction(step));
    return at;
  }
  ConstraintStep constraint_step(int step) const
  {
    ConstraintStep now{ time + (step + 1) * dt, dt, time + step * dt, bones(step), bones(step - 1), {}, step };
    now.activation.resize(begin.activation.size());
    activation(step, now.activation.data());
    return now;
  }
};

}  // namespace frontalis
