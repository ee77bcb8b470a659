#include "frontalis/ros/face_node.hpp"

#include "frontalis/model/effects.hpp"
#include "frontalis/runner/profile_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>

namespace frontalis
{

namespace
{

constexpr double stalled_after = 3.0;  // diagnostics warn if there is no frame for this time [s]

}  // namespace

void FaceNode::send_diagnostics()
{
  try
  {
    updater_.force_update();
  }
  catch (const std::exception& error)
  {
    // diagnostic_updater reads ~diagnostic_period each time, and throws if ROS cannot count so long a duration
    if (diagnostics_warning_.passes(10))
      ROS_ERROR_STREAM(name_ << ": no diagnostics: " << error.what());
  }
}

void FaceNode::diagnose(diagnostic_updater::DiagnosticStatusWrapper& status)
{
  using diagnostic_msgs::DiagnosticStatus;
  std::string reason;
  const auto running = runner(&reason);
  if (!running)
  {
    const std::lock_guard<std::mutex> lock(runner_mutex_);
    status.summary(load_fault_.empty() ? DiagnosticStatus::WARN : DiagnosticStatus::ERROR, reason);
    return;
  }

  std::unique_lock<std::mutex> lock(frame_mutex_);
  const bool moves_by_itself = parameters_.runner.pace != Pace::lock_step && !paused_;
  const double silence = (ros::WallTime::now() - last_frame_).toSec();
  const bool lacks_clock = ros::Time::isSimTime() && ros::Time::now().isZero();
  if (lacks_clock && moves_by_itself && has_frame_)
    ROS_WARN_STREAM_ONCE(
        name_
        << ": /use_sim_time is true, but nobody publishes /clock: a face at the pace real_time stands still, and all "
           "messages have the time 0, which rviz, tf2 and cameras do not show");
  if (frame_.failed)
    status.summary(DiagnosticStatus::ERROR, frame_.failure);
  else if (!frame_finite_)
    status.summary(DiagnosticStatus::ERROR, "the latest frame is not finite and was not published; call ~reset");
  else if (const double most = std::max(stalled_after, 2 / running->frame_rate());
           moves_by_itself && (!has_frame_ || silence > most))
    status.summaryf(DiagnosticStatus::WARN, "no frame for more than %g seconds", most);
  else if (lacks_clock && moves_by_itself)
    status.summary(DiagnosticStatus::WARN, "/use_sim_time is true, but nobody publishes /clock");
  else if (!moves_by_itself)
    status.summary(DiagnosticStatus::OK, parameters_.runner.pace == Pace::lock_step ? "waiting for ~step" : "paused");
  else if (parameters_.runner.pace == Pace::real_time && frame_.time > 1 &&
           frame_.real_time_factor < parameters_.real_time_factor_warning)
    status.summaryf(DiagnosticStatus::WARN, "too slow: the real-time factor is %.3g, below %.3g",
                    frame_.real_time_factor, parameters_.real_time_factor_warning);
  else
    status.summaryf(DiagnosticStatus::OK, "running with a real-time factor of %.3g", frame_.real_time_factor);

  status.add("backend", running->description());
  status.add("accuracy", measured_profile(running->model()));
  status.add("speed", speed_report_);
  status.add("simulated time [s]", frame_.time);
  status.add("real-time factor", frame_.real_time_factor);
  status.add("time step [s]", frame_.time_step);
  status.add("steps", frame_.steps);
  status.add("kinetic energy [J]", frame_.monitor.kinetic);
  status.add("internal energy [J]", frame_.monitor.internal);
  status.add("hourglass energy [J]", frame_.monitor.hourglass);
  status.add("smallest volume ratio", frame_.monitor.worst_jacobian);
  status.add("inverted voxels", frame_.monitor.inverted);
  status.add("nodes past the rim of their surface", frame_.monitor.past_rim);
  status.add("returns to an earlier stable state", frame_.guard.rollbacks);
  if (frame_.guard.rollbacks > 0)
    status.add("reason of the latest return", words_for(frame_.guard.latest));
  status.add("frames not published as not finite", frames_dropped_);
  if (frame_.seconds_per_step > 0)
    status.add("wall time per step [us]", 1e6 * frame_.seconds_per_step);
  status.add("memory of the solver [MB]", static_cast<double>(frame_.solver_bytes) / 1e6);
  lock.unlock();
  const EffectSet of_model = effects_of(running->model()), switched_on = running->effects();
  std::vector<std::string> off;
  for (const Effect effect : every_effect())
    if (of_model.has(effect) && !switched_on.has(effect))
      off.push_back(name_of(effect));
  status.add("effects switched off", off.empty() ? "none" : fmt::format("{}", fmt::join(off, ", ")));
  inputs_.diagnose(status);
}

}  // namespace frontalis
