#include "solver/stepping/step_plan.hpp"

#include "frontalis/solver/rigid_motion.hpp"

namespace frontalis
{

void StepPlan::activation(int step, float* out) const
{
  const auto f = static_cast<float>(fraction(step));
  for (std::size_t m = 0; m < begin.activation.size(); ++m)
    out[m] = begin.activation[m] + f * (end.activation[m] - begin.activation[m]);
}

ConstraintStep StepPlan::constraint_step(int step) const
{
  ConstraintStep now{ time + (step + 1) * dt, dt, {}, {} };
  for (std::size_t b = 0; b < begin.bone.size(); ++b)
  {
    now.bone.push_back(interpolate(begin.bone[b], end.bone[b], fraction(step)));
    now.bone_before.push_back(interpolate(begin.bone[b], end.bone[b], fraction(step - 1)));
  }
  return now;
}

std::vector<double> relaxation_times(int steps, double dt, double interval)
{
  std::vector<double> seconds(steps, 0);
  double elapsed = 0;
  for (int step = 0; step < steps; ++step)
  {
    elapsed += dt;
    if (step + 1 < steps && elapsed < interval)
      continue;
    seconds[step] = elapsed;
    elapsed = 0;
  }
  return seconds;
}

}  // namespace frontalis
