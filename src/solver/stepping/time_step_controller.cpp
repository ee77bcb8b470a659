#include "solver/stepping/time_step_controller.hpp"

#include "frontalis/error.hpp"
#include "frontalis/physics/mutation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

// These values are empirical: with them the hard cases of doc/stability.md pass.
// Cautious steps: fraction of the critical step, and their number after signs of stiffening. What searches find already
// has a margin, of a quarter of the squared frequency while tissue moves.
struct Caution
{
  double share;
  int steps_after_stiffening;
};
constexpr Caution with_bound{ 0.55, 128 }, with_searches{ 0.62, 32 };
constexpr int cautious_plan = 8;    // number of steps in a cautious plan
constexpr int vibration_plan = 32;  // largest number of steps in a plan while tissue vibrates
constexpr int fast_plan = 16;       // and while it moves fast
// Longest path of a node in a step, in shortest voxel edges. Tissue that moves faster crushes voxels within a few
// steps.
constexpr double way_per_step = 0.15;
constexpr double least_share = 0.1;  // of the step for that; what needs less is flung away, which the guard reports
// The following constants define signs of fast change, and the number of cautious steps after each.
constexpr double growth_between_plans = 1.1;       // ratio of covered squared frequencies of successive plans
constexpr float activation_change_allowed = 0.3F;  // change of a muscle's activation within a plan
constexpr int steps_after_a_switch = 48;
// After a jump of a bone's velocity: the shorter of the two.
constexpr int steps_after_a_jump = 1000;
constexpr double time_after_a_jump = 0.01;  // [s]
// Tissue that is much stiffer than at rest and changes from plan to plan vibrates; a contraction stiffens tissue
// slowly.
constexpr double stiffening_ratio = 4;     // ratio of the squared frequency to that at rest
constexpr double vibration_change = 0.05;  // relative change of the squared frequency between plans
constexpr int steps_after_vibration = 256;
// The bound follows softening slowly, because tissue may stiffen again soon, and each change of the step costs
// accuracy.
constexpr double slowest_softening = 0.95;  // ratio of squared frequencies of successive plans

}  // namespace

TimeStepController::TimeStepController(double bound_at_rest, TimeStepEstimate estimate, double safety_share,
                                       double fixed_step)
    : bound_at_rest_(bound_at_rest),
      safety_share_(safety_share),
      fixed_step_(fixed_step),
      assembled_(estimate == TimeStepEstimate::assembled)
{
  reset();
  if (!(fixed_step >= 0 && fixed_step <= critical_step(1)))
    throw Error(fmt::format("time step {:g} s refused: allowed is 0 (found by the solver) to the critical {:g} s",
                            fixed_step, critical_step(1)));
}

void TimeStepController::reset()
{
  state_ = {};
  state_.measured = state_.latest_measured = measured_at_rest();
}

double TimeStepController::covered(double measured) const
{
  return state_.assembled.known() ? state_.assembled.covered(measured) : measured;
}

double TimeStepController::critical_step_at(double measured) const { return 2 / std::sqrt(covered(measured)); }

double TimeStepController::critical_step(double share) const { return share * critical_step_at(state_.measured); }

double TimeStepController::cautious_step() const
{
  return critical_step((assembled_ ? with_searches : with_bound).share);
}

int TimeStepController::steps_after_stiffening() const
{
  return (assembled_ ? with_searches : with_bound).steps_after_stiffening;
}

double TimeStepController::safe_step() const
{
  const double critical = critical_step(1);
  const double slow = fixed_step_ > 0 ? std::min(fixed_step_, critical) : safety_share_ * critical;
  return slow_share_ * std::clamp(way_per_step / state_.speed, least_share * slow, slow);
}

void TimeStepController::slow_down(double share)
{
  if (!(share > 0 && share <= 1))
    throw Error(fmt::format("{:g} of the time step: allowed are shares above 0 up to 1", share));
  slow_share_ = share;
}

double TimeStepController::alarming() const { return growth_between_plans * covered(state_.measured); }

TimeStepController::Choice TimeStepController::choose(double remaining, double longest, double longest_plan,
                                                      const BackendTraits& backend) const
{
  const bool vibrates = state_.vibration_steps_left > 0, in_motion = state_.assembled.in_motion();
  double dt = safe_step();
  const bool fast = state_.speed * dt > 0.5 * slow_share_ * way_per_step;
  int most_steps = static_cast<int>(std::clamp(backend.seconds_per_plan / dt, double(backend.fewest_steps_per_plan),
                                               double(backend.most_steps_per_plan)));
  if (longest_plan < most_steps * dt)
    most_steps = std::max(1, static_cast<int>(longest_plan / dt));
  if (state_.cautious_steps_left > 0 || vibrates)
    dt = std::min(dt, slow_share_ * cautious_step());
  const bool cautious = state_.cautious_steps_left > 0 || longest <= dt;
  if (cautious)
    most_steps = std::max(1, static_cast<int>(std::min<double>(longest_plan / dt, cautious_plan)));
  else if (vibrates)
    most_steps = std::min(vibration_plan, most_steps);
  if (fast)
    most_steps = std::min(fast_plan, most_steps);
  if (in_motion)
    most_steps = static_cast<int>(std::min<std::int64_t>(most_steps, state_.assembled.steps_left()));
  // Without the tolerance, a rounding error could add a step.
  const double steps_left = std::ceil(remaining / std::min(dt, longest) * (1 - 1e-9));
  return { static_cast<int>(std::min<double>(steps_left, most_steps)), remaining / steps_left, steps_left <= most_steps,
           cautious, cautious || vibrates || fast || in_motion };
}

void TimeStepController::observe(double measured, double speed, int steps)
{
  state_.speed = speed;
  state_.assembled.steps_taken(steps, covered(state_.measured));
  const double now = covered(measured),
               at_rest = state_.assembled.known() ? state_.assembled.softest() : bound_at_rest_;
  const bool changes = std::abs(now - state_.latest_covered) > vibration_change * state_.latest_covered;
  const bool vibrates = changes && now > stiffening_ratio * at_rest;
  const bool stiffens = measured > alarming();
  state_.latest_covered = now;
  state_.cautious_steps_left = std::max(stiffens ? steps_after_stiffening() : 0, state_.cautious_steps_left - steps);
  state_.vibration_steps_left = std::max(vibrates ? steps_after_vibration : 0, state_.vibration_steps_left - steps);
  // The assembled estimate does not soften before the next search.
  const double softened = (assembled_ ? 1 : slowest_softening) * state_.measured;
  if (!mutation::time_step_of_rest)
    state_.measured = std::max({ measured, softened, measured_at_rest() });
  state_.latest_measured = measured;
}

AssembledEstimate::Renewal TimeStepController::renew_assembled(const std::vector<float>& activation, bool moving,
                                                               const AssembledEstimate::Search& search)
{
  const auto renewal = state_.assembled.renew(activation, moving, state_.latest_measured, bound_at_rest_, search);
  if (renewal.searched)
  {
    const double found = state_.assembled.latest();
    state_.measured = state_.latest_measured = found > 0 && std::isfinite(found) ? found : bound_at_rest_;
  }
  return renewal;
}

bool TimeStepController::muscles_switched(const std::vector<float>& from, const std::vector<float>& to)
{
  for (std::size_t m = 0; m < to.size(); ++m)
    if (std::abs(to[m] - from[m]) > activation_change_allowed)
    {
      state_.cautious_steps_left = std::max(state_.cautious_steps_left, steps_after_a_switch);
      return true;
    }
  return false;
}

void TimeStepController::bone_jumped()
{
  const double steps = time_after_a_jump / cautious_step();
  state_.cautious_steps_left =
      std::max(state_.cautious_steps_left, static_cast<int>(std::min<double>(steps, steps_after_a_jump)));
}

void TimeStepController::displacements_set(double measured)
{
  state_.assembled.discard();
  state_.measured = measured_at_rest();
  if (std::isfinite(measured))
    state_.measured = std::max(measured, measured_at_rest());
  state_.latest_measured = state_.measured;
  state_.cautious_steps_left = steps_after_stiffening();
}

void TimeStepController::set_bound_at_rest(double squared)
{
  bound_at_rest_ = squared;
  state_.assembled.discard();
  if (assembled_)
    state_.measured = state_.latest_measured = squared;
}

}  // namespace frontalis
