#pragma once

#include "frontalis/physics/element/node_motion.hpp"
#include "frontalis/solver/rigid_motion.hpp"
#include "frontalis/solver/solver.hpp"
#include "solver/stepping/constraint_step.hpp"

namespace frontalis
{

/// What acts on the tissue besides bones. The time stepper changes it between two plans; backends read it.
struct Conditions
{
  EffectSet running;
  std::array<double, 3> gravity{};   ///< [m/s2] on the masses as they are scaled; 0 where the effect is off
  double damping = 0;                ///< mass-proportional [1/s]
  std::vector<float> activation;     ///< of each muscle now, as its fibres feel it: 0 where contraction is off
  std::vector<RigidTransform> bone;  ///< poses now

  template <class Real>
  physics::Kick<Real> kick(double seconds) const
  {
    return physics::kick_of<Real>(damping, seconds, gravity);
  }
};

/// Part of a motion in equal steps, over which activations and bone poses go linearly from begin to end.
struct StepPlan
{
  int steps = 0;
  double dt = 0;  ///< [s]
  /// For how long forces change velocities in the first step [s]. It differs from dt where the step before had another
  /// length, because velocities stand half a step before displacements.
  double first_kick = 0;
  double time = 0;                        ///< at its begin [s]
  bool bound_every_step = false;          ///< the frequency bound is found in every step, else in the last alone
  bool bound_awaited = false;             ///< run() has to return the bound of this plan, not of the plan before
  double alarming_frequency_squared = 0;  ///< a bound above it has to be followed by that of this plan [1/s2]
  Controls begin, end;                    ///< activations as fibres feel them
  std::vector<double> relaxation;         ///< one per step: by how much viscous stresses relax after it [s]

  double fraction(int step) const { return (step + 1.0) / steps; }
  void activation(int step, float* out) const
  {
    const auto f = static_cast<float>(fraction(step));
    for (std::size_t m = 0; m < begin.activation.size(); ++m)
      out[m] = begin.activation[m] + f * (end.activation[m] - begin.activation[m]);
  }
  ConstraintStep constraint_step(int step) const
  {
    ConstraintStep now{ time + (step + 1) * dt, dt, time + step * dt, {}, {} };
    for (std::size_t b = 0; b < begin.bone.size(); ++b)
    {
      now.bone.push_back(interpolate(begin.bone[b], end.bone[b], fraction(step)));
      now.bone_before.push_back(interpolate(begin.bone[b], end.bone[b], fraction(step - 1)));
    }
    return now;
  }
};

}  // namespace frontalis
