#include "solver/stepping/stepping_solver.hpp"

#include "frontalis/error.hpp"
#include "frontalis/model/effects.hpp"
#include "frontalis/physics/mutation.hpp"
#include "frontalis/solver/rigid_motion.hpp"
#include "solver/energy/voxel_monitor.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <sstream>

namespace frontalis
{
namespace
{

constexpr int close_steps = 8;              // between looks that follow closely
constexpr int restless_steps = 32;          // between looks at what vibrates
constexpr double alert_share = 0.55;        // of the critical time step
constexpr double much_stiffer = 4;          // than at rest, of the frequency squared
constexpr double stiffening_allowed = 1.1;  // of the frequency squared from look to look
constexpr double restless_change = 0.05;    // of it from look to look
constexpr int steps_after_stiffening = 128;
constexpr int steps_after_restlessness = 256;
constexpr float activation_a_plan = 0.3F;  // that calls for close looks
constexpr int steps_after_a_switch = 48;
constexpr double jerk_felt = 0.005;  // change of a bone's way a step, in edges of a voxel
constexpr int steps_after_a_jerk = 1000;

double seconds_since(std::chrono::steady_clock::time_point start)
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

Controls interpolate(const Controls& from, const Controls& to, double fraction)
{
  Controls result = to;
  for (std::size_t m = 0; m < result.activation.size(); ++m)
    result.activation[m] = from.activation[m] + static_cast<float>(fraction) * (to.activation[m] - from.activation[m]);
  for (std::size_t b = 0; b < result.bone.size(); ++b)
    result.bone[b] = interpolate(from.bone[b], to.bone[b], fraction);
  return result;
}

Controls rest_controls(const Model& model)
{
  return { std::vector<float>(model.muscles.size(), 0), std::vector<RigidTransform>(model.bones.size()) };
}

SteppingSolver::SteppingSolver(std::shared_ptr<const Model> model, const SolverSettings& settings)
    : model_((check_model(*model), std::move(model))),
      discretisation_(*model_),
      wants_ledger_(settings.ledger),
      damping_(model_->damping),
      effects_(effects_of(*model_)),
      forced_time_step_(settings.time_step)
{
  set_gravity();
  frequency_squared_ = discretisation_.frequency_squared_max;
  controls_ = rest_controls(*model_);
  activation_ = controls_.activation;
  const double critical = 2 / std::sqrt(frequency_squared_);
  if (!(forced_time_step_ >= 0 && forced_time_step_ <= critical))
  {
    std::ostringstream text;
    text << "time step " << forced_time_step_ << " s refused: allowed is 0 (found by the solver) to the critical "
         << critical << " s";
    throw Error(text.str());
  }
}

double SteppingSolver::critical_frequency_squared() const
{
  // what softens where the bound is set need not soften in the assembled model
  if (assembled_share_ < 1)
    return assembled_share_ * std::max(frequency_squared_, assembled_at_frequency_);
  return frequency_squared_;
}

double SteppingSolver::safe_time_step() const
{
  const double critical = 2 / std::sqrt(critical_frequency_squared());
  return slow_share_ *
         (forced_time_step_ > 0 ? std::min(forced_time_step_, critical) : model_->time_step_share * critical);
}

// Just below the critical step what stiffens as it vibrates gains or loses energy in every swing.
double SteppingSolver::careful_time_step() const
{
  const double safe = safe_time_step();
  if (wary_ == 0 && restless_ == 0)
    return safe;
  return std::min(safe, slow_share_ * alert_share * 2 / std::sqrt(critical_frequency_squared()));
}

double SteppingSolver::keep(double dt) const { return (1 - 0.5 * damping_ * dt) / (1 + 0.5 * damping_ * dt); }

double SteppingSolver::gain(double dt) const { return dt / (1 + 0.5 * damping_ * dt); }

void SteppingSolver::velocities_were_set()
{
  if (wants_ledger_ && !settling_)
    open_ledger();
}

void SteppingSolver::displacements_were_set()
{
  const double critical = monitor().critical_time_step;
  const double squared = 4 / (critical * critical);
  frequency_squared_ = discretisation_.frequency_squared_max;
  latest_step_ = 0;
  if (std::isfinite(squared))
    frequency_squared_ = std::max(squared, frequency_squared_);
  wary_ = steps_after_stiffening;
  assembled_share_ = 1;
  assembled_at_frequency_ = 0;
  velocities_were_set();
}

void SteppingSolver::reset()
{
  rest();
  static_cast<Course&>(*this) = {};
  frequency_squared_ = discretisation_.frequency_squared_max;
  controls_ = rest_controls(*model_);
  activation_ = controls_.activation;
  profile_ = {};
  velocities_were_set();
}

void SteppingSolver::check(double seconds, const Controls& target) const
{
  if (!(seconds >= 0) || !std::isfinite(seconds))
    throw Error("advance by " + std::to_string(seconds) + " s: allowed are finite durations from 0");
  if (target.activation.size() != model_->muscles.size() || target.bone.size() != model_->bones.size())
    throw Error("controls for " + std::to_string(target.activation.size()) + " muscles and " +
                std::to_string(target.bone.size()) + " bones; the model has " + std::to_string(model_->muscles.size()) +
                " and " + std::to_string(model_->bones.size()));
  for (std::size_t m = 0; m < target.activation.size(); ++m)
    if (!(target.activation[m] >= 0 && target.activation[m] <= 1))
      throw Error("activation of " + model_->muscles[m].name + " is " + std::to_string(target.activation[m]) +
                  "; allowed is 0 to 1");
  for (std::size_t b = 0; b < target.bone.size(); ++b)
    if (!is_rigid_motion(target.bone[b]))
      throw Error("pose of bone " + model_->bones[b] + " is not a finite rigid motion");
  if (failed_)
    throw Error("the motion has diverged earlier: reset the solver first");
}

// first-order response of the muscles to activations asked for that go linearly from one to another:
// da/dt = (e - a) / time, with the rise or the fall time (as in Zajac 1989, Crit. Rev. Biomed. Eng. 17:359), no faster
// than the slew limit
void SteppingSolver::respond(const std::vector<float>& from, const std::vector<float>& to, double seconds)
{
  for (std::size_t m = 0; m < activation_.size(); ++m)
  {
    const Muscle& muscle = model_->muscles[m];
    const double now = double(activation_[m]);
    const double time = double(to[m]) > now ? muscle.rise_time : muscle.fall_time;
    double reached = double(to[m]);
    if (time > 0)
    {
      const double lag = (double(to[m]) - double(from[m])) * time / seconds;
      reached += -lag + (now - double(from[m]) + lag) * std::exp(-seconds / time);
    }
    if (model_->activation_slew > 0)
    {
      const double most = model_->activation_slew * seconds;
      reached = std::min(std::max(reached, now - most), now + most);
    }
    activation_[m] = static_cast<float>(std::min(std::max(reached, 0.0), 1.0));
  }
}

// What grows fast is watched closely. What is much stiffer than at rest and changes, vibrates; what a contraction
// stiffens slowly does not.
void SteppingSolver::watch(double squared, const StepPlan& plan)
{
  const bool changes = std::abs(squared - latest_seen_) > restless_change * latest_seen_;
  const bool restless = changes && squared > much_stiffer * discretisation_.frequency_squared_max;
  latest_seen_ = squared;
  wary_ = std::max(squared > plan.alarm ? steps_after_stiffening : 0, wary_ - plan.steps);
  restless_ = std::max(restless ? steps_after_restlessness : 0, restless_ - plan.steps);
}

// what softens is believed slowly: it may stiffen again before the next look, and each change of the time step costs
// accuracy
void SteppingSolver::expect_frequency(double squared)
{
  frequency_squared_ = std::max({ squared, 0.95 * frequency_squared_, discretisation_.frequency_squared_max });
}

void SteppingSolver::advance(double seconds, const Controls& target)
{
  check(seconds, target);
  const auto start = std::chrono::steady_clock::now();
  const double end = time_ + seconds;
  const Controls from = controls_;
  const double begin = time_;
  const double steady = steady_step(target.bone, seconds);
  if (jerk_of_bones(target.bone, seconds) * safe_time_step() > jerk_felt)
    wary_ = std::max(wary_, steps_after_a_jerk);
  if (seconds > 0)
  {
    bone_before_ = from.bone;
    bone_seconds_ = seconds;
  }
  while (time_ < end)
  {
    if (model_->time_step_estimate == TimeStepEstimate::assembled)
      renew_assembled_bound(target.activation);
    const double remaining = end - time_;
    const double longest = std::min(careful_time_step(), steady);
    const double steps_left = std::ceil(remaining / longest * (1 - 1e-9));
    StepPlan plan;
    plan.closely = wary_ > 0 || longest == steady;
    plan.awaited = plan.closely || restless_ > 0;
    const int most_steps = plan.closely    ? close_steps
                           : restless_ > 0 ? std::min(restless_steps, steps_a_plan())
                                           : steps_a_plan();
    plan.steps = static_cast<int>(std::min<double>(steps_left, most_steps));
    plan.dt = remaining / steps_left;
    plan.first_kick = latest_step_ > 0 ? 0.5 * (latest_step_ + plan.dt) : plan.dt;
    plan.time = time_;
    const bool last = steps_left <= most_steps;
    const double reached = last ? end : time_ + plan.steps * plan.dt;
    const Controls next = last ? target : interpolate(from, target, (reached - begin) / seconds);
    plan.begin = { activation_, controls_.bone };
    respond(controls_.activation, next.activation, plan.steps * plan.dt);
    plan.end = { activation_, next.bone };
    // muscles that are switched stiffen their voxels, and so do these what they draw, a little later
    for (std::size_t m = 0; m < plan.end.activation.size(); ++m)
      if (std::abs(plan.end.activation[m] - plan.begin.activation[m]) > activation_a_plan)
      {
        plan.closely = plan.awaited = true;
        wary_ = std::max(wary_, steps_after_a_switch);
      }
    plan.alarm = stiffening_allowed * frequency_squared_;
    const double squared = run(plan);
    time_ = reached;
    latest_step_ = plan.dt;
    controls_ = next;
    profile_.steps += plan.steps;
    if (!std::isfinite(squared))
    {
      failed_ = true;
      throw Diverged("the motion diverged at " + std::to_string(time_) + " s: displacements are no longer finite");
    }
    watch(squared, plan);
    if (!mutation::time_step_of_rest)
      expect_frequency(squared);
  }
  controls_ = target;
  profile_.stepping += seconds_since(start);
}

Monitor SteppingSolver::measure()
{
  Vectors u, v;
  displacements(u);
  velocities(v);
  return monitor_voxels(*model_, discretisation_, u, v);
}

Monitor SteppingSolver::monitor()
{
  const auto start = std::chrono::steady_clock::now();
  Monitor result = measure();
  result.step_share = latest_step_ * std::sqrt(assembled_share_) / result.critical_time_step;
  profile_.monitor += seconds_since(start);
  return result;
}

}  // namespace frontalis
