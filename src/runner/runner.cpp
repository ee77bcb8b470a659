#include "frontalis/runner/runner.hpp"

#include "frontalis/error.hpp"
#include "frontalis/runner/named_controls.hpp"
#include "runner/runner_implementation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace frontalis
{

Runner::Runner(std::shared_ptr<const Model> model, const RunnerSettings& settings, OnFrame on_frame)
    : self_(std::make_unique<Implementation>())
{
  self_->model = std::move(model);
  self_->settings = settings;
  set_frame_rate(settings.frame_rate);
  set_damping(-1);
  self_->on_frame = std::move(on_frame);
  self_->solver = make_solver(self_->model, settings.solver);
  if (settings.guard)
    self_->guard = std::make_unique<Guard>(*self_->solver, self_->model, *settings.guard);
  // At the pace of real time a frame must not be late, so that it uses the latest lines that are ready.
  self_->fine_lines = FineLines::make(self_->model, settings.pace == Pace::real_time);
  self_->target = self_->solver->controls();
  self_->effects = self_->solver->effects();
  self_->thread = std::thread([this] { self_->run(); });
}

Runner::~Runner()
{
  {
    const std::lock_guard<std::mutex> lock(self_->mutex);
    self_->stop = true;
  }
  self_->wake.notify_all();
  self_->thread.join();
}

void Runner::set_frame_rate(double rate)
{
  const double found = rate > 0 ? rate : self_->model->frame_rate;
  if (!(found >= slowest_frame_rate && found <= fastest_frame_rate))
    throw Error(fmt::format("frame rate {} Hz: allowed is {} to {}", found, slowest_frame_rate, fastest_frame_rate));
  self_->frame_rate = found;
}

double Runner::frame_rate() const { return self_->frame_rate; }

void Runner::set_damping(double damping)
{
  if (!std::isfinite(damping))
    throw Error(fmt::format("damping {}: allowed are finite numbers; below 0: the model's", damping));
  self_->damping = damping < 0 ? self_->model->damping : damping;
}

void Runner::set_activation(const std::map<std::string, double>& activation)
{
  const std::lock_guard<std::mutex> lock(self_->mutex);
  set_activations(*self_->model, activation, self_->target.activation);
}

void Runner::set_expression(const std::string& name)
{
  const Controls pose = expression_controls(*self_->model, name);
  const std::lock_guard<std::mutex> lock(self_->mutex);
  take_pose(*self_->model, pose, self_->target);
}

void Runner::set_bone(const std::string& name, const RigidTransform& motion)
{
  const std::lock_guard<std::mutex> lock(self_->mutex);
  set_bone_motion(*self_->model, name, motion, self_->target.bone);
}

std::vector<RigidTransform> Runner::bones() const
{
  const std::lock_guard<std::mutex> lock(self_->mutex);
  return self_->target.bone;
}

void Runner::switch_effect(Effect effect, bool on)
{
  const std::lock_guard<std::mutex> one_at_a_time(self_->switch_mutex);
  Implementation::SwitchRequest request{ effect, on, false, {} };
  std::unique_lock<std::mutex> lock(self_->mutex);
  self_->switch_request = &request;
  self_->wake.notify_all();
  self_->wake.wait(lock, [&] { return request.done; });
  if (!request.error.empty())
    throw Error(request.error);
}

EffectSet Runner::effects() const
{
  const std::lock_guard<std::mutex> lock(self_->mutex);
  return self_->effects;
}

void Runner::pause(bool paused)
{
  {
    const std::lock_guard<std::mutex> lock(self_->mutex);
    self_->paused = paused;
  }
  self_->wake.notify_all();
}

bool Runner::paused() const
{
  const std::lock_guard<std::mutex> lock(self_->mutex);
  return self_->paused;
}

void Runner::reset()
{
  std::unique_lock<std::mutex> lock(self_->mutex);
  std::fill(self_->target.activation.begin(), self_->target.activation.end(), 0.0f);
  std::fill(self_->target.bone.begin(), self_->target.bone.end(), RigidTransform{});
  const std::uint64_t own = ++self_->resets_wanted;
  self_->wake.notify_all();
  self_->wake.wait(lock, [&] { return self_->resets_done >= own || self_->stop; });
  if (!self_->reset_error.empty())
    throw Error("reset failed: " + self_->reset_error);
}

void Runner::cancel_step()
{
  const std::lock_guard<std::mutex> lock(self_->mutex);
  self_->cancel_wanted = self_->step_request != nullptr;
}

Frame Runner::step(double seconds, bool hands_out)
{
  if (!(seconds > 0) || !std::isfinite(seconds))
    throw Error(fmt::format("step of {} s: allowed are finite durations above 0", seconds));
  Implementation::StepRequest request;
  request.seconds = seconds;
  request.hands_out = hands_out;
  std::unique_lock<std::mutex> lock(self_->mutex);
  if (self_->step_request != nullptr)
    throw Error("another step is under way");
  self_->paused = true;
  self_->step_request = &request;
  self_->wake.notify_all();
  self_->wake.wait(lock, [&] { return request.done; });
  if (!request.error.empty())
    throw Error(request.error);
  return request.frame;
}

const Model& Runner::model() const { return *self_->model; }
std::string Runner::description() const { return self_->solver->description(); }

}  // namespace frontalis
