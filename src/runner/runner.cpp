#include "frontalis/runner/runner.hpp"

#include "frame_clock.hpp"
#include "frontalis/error.hpp"
#include "frontalis/runner/face_frame.hpp"
#include "frontalis/runner/named_controls.hpp"
#include "frontalis/solver/rigid_motion.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <thread>

namespace frontalis
{
namespace
{

using Clock = std::chrono::steady_clock;

// time steps between two looks at the wall clock
constexpr int steps_a_slice = 32;

// too close for the difference to be seen
bool close(const RigidTransform& a, const RigidTransform& b)
{
  const auto near = [](double within) { return [within](double x, double y) { return std::abs(x - y) < within; }; };
  return std::equal(a.rotation.begin(), a.rotation.end(), b.rotation.begin(), near(1e-5)) &&
         std::equal(a.translation.begin(), a.translation.end(), b.translation.begin(), near(1e-6));
}

}  // namespace

struct Runner::Implementation
{
  std::shared_ptr<const Model> model;
  RunnerSettings settings;
  OnFrame on_frame;
  std::unique_ptr<Solver> solver;
  std::unique_ptr<Guard> guard;  // may be none

  // shared with the callers' threads, under the mutex
  mutable std::mutex mutex;
  std::condition_variable wake;
  Controls target;
  bool stop = false;
  bool paused = false;
  bool reset_wanted = false;
  bool cancel_wanted = false;
  std::uint64_t resets_done = 0;
  struct StepRequest
  {
    double seconds = 0;
    bool done = false;
    std::string error;
    Frame frame;
  };
  StepRequest* step_request = nullptr;
  struct SwitchRequest
  {
    Effect effect;
    bool on;
    bool done = false;
    std::string error;
  };
  SwitchRequest* switch_request = nullptr;
  EffectSet effects;
  std::mutex step_mutex, switch_mutex;  // one step, one switch at a time

  // the runner's thread alone
  Frame frame;
  FrameClock clock;
  Clock::time_point deadline{};  ///< of the frame under way; frames keep to a schedule, late or not
  Clock::time_point start = Clock::now();
  Clock::time_point last_monitor{};
  std::thread thread;

  double period() const { return 1 / settings.frame_rate; }
  /// On the clock on which activations are given.
  double time() const { return solver->time() * model->time_scaling; }

  void advance(double seconds, const Controls& to);
  void make_frame(bool renew_monitor);
  void publish(bool renew_monitor = false);
  void run_frame();
  void serve_step(StepRequest& request);
  void serve_switch(SwitchRequest& request);
  void refuse_requests(const std::string& error);
  void loop();
  void guarded_loop();
};

// advances on the activations' clock; a motion that cannot be trusted stops the face until reset
void Runner::Implementation::advance(double seconds, const Controls& to)
{
  try
  {
    if (guard)
      guard->advance(seconds / model->time_scaling, to);
    else
      solver->advance(seconds / model->time_scaling, to);
  }
  catch (const Error& error)
  {
    frame.failed = true;
    frame.failure = error.what();
  }
}

void Runner::Implementation::make_frame(bool renew_monitor)
{
  const auto now = Clock::now();
  if (!frame.failed)
  {
    SkinState skin;
    solver->skin(skin);
    if (is_finite(skin))
    {
      to_face_frame(*model, skin);
      frame.skin = std::move(skin);
      const auto field = settings.wanted_field ? settings.wanted_field() : std::nullopt;
      if (field)
        solver->skin_field(*field, frame.field);
      else
        frame.field.clear();
    }
    else
    {
      frame.failed = true;
      frame.failure = "the skin is no longer finite";
    }
    if (!frame.failed && (renew_monitor || now - last_monitor > std::chrono::seconds(1)))
    {
      frame.monitor = solver->monitor();
      last_monitor = now;
    }
  }
  frame.time = time();
  frame.wall_time = std::chrono::duration<double>(now - start).count();
  frame.time_step = solver->time_step();
  frame.steps = solver->profile().steps;
  frame.activation = solver->activation();
  if (guard)
    frame.guard = guard->counts();
  ++frame.sequence;
}

void Runner::Implementation::publish(bool renew_monitor)
{
  frame.real_time_factor = clock.note(time());
  make_frame(renew_monitor);
  if (on_frame)
    on_frame(frame);
}

// one frame's worth of stepping: until the simulated time that is due is reached or the frame's wall time is over
void Runner::Implementation::run_frame()
{
  const auto length = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(period()));
  // the next one on the schedule; a frame that is lost altogether is not caught up
  deadline = std::max(deadline + length, Clock::now() + length / 4);
  deadline = std::min(deadline, Clock::now() + length);
  const double end =
      settings.pace == Pace::fastest ? time() + 1e9 : time() + clock.due(time(), 2 * period()) + period();
  while (!frame.failed && time() < end && Clock::now() < deadline)
  {
    Controls to;
    {
      const std::lock_guard<std::mutex> lock(mutex);
      if (stop || paused || reset_wanted || step_request != nullptr)
        return;
      to = target;
    }
    // controls reach their target within a frame's time, not in one step
    const double slice = std::min(end - time(), steps_a_slice * solver->time_step() * model->time_scaling);
    const auto part = static_cast<float>(std::min(1.0, slice / period()));
    const Controls& now = solver->controls();
    for (std::size_t m = 0; m < to.activation.size(); ++m)
    {
      const float way = to.activation[m] - now.activation[m];
      to.activation[m] = std::abs(way) < 1e-4f ? to.activation[m] : now.activation[m] + way * std::min(1.0f, 3 * part);
    }
    for (std::size_t b = 0; b < to.bone.size(); ++b)
      if (!close(now.bone[b], to.bone[b]))
        to.bone[b] = interpolate(now.bone[b], to.bone[b], std::min(1.0f, 3 * part));
    advance(slice, to);
  }
  publish();
  std::unique_lock<std::mutex> lock(mutex);
  if (settings.pace == Pace::real_time || frame.failed)
    wake.wait_until(lock, deadline,
                    [&] { return stop || reset_wanted || step_request != nullptr || switch_request != nullptr; });
}

void Runner::Implementation::serve_step(StepRequest& request)
{
  Controls to;
  {
    const std::lock_guard<std::mutex> lock(mutex);
    to = target;
  }
  if (frame.failed)
    request.error = frame.failure + "; reset first";
  const Controls from = solver->controls();
  clock.restart(time());
  for (double done = 0; done < request.seconds && request.error.empty();)
  {
    // in slices, so that a long step can be stopped
    const double slice = std::min(request.seconds - done, steps_a_slice * solver->time_step() * model->time_scaling);
    done += slice;
    advance(slice, interpolate(from, to, std::min(1.0, done / request.seconds)));
    request.error = frame.failure;
    const std::lock_guard<std::mutex> lock(mutex);
    if (stop || reset_wanted || cancel_wanted)
      request.error = "the step was ended early";
  }
  publish(true);
  request.frame = frame;
}

// under the mutex
void Runner::Implementation::serve_switch(SwitchRequest& request)
{
  try
  {
    solver->switch_effect(request.effect, request.on);
    effects = solver->effects();
    if (guard && !frame.failed)
      guard->restart();
  }
  catch (const Error& error)
  {
    request.error = error.what();
  }
  request.done = true;
  switch_request = nullptr;
  wake.notify_all();
}

// under the mutex
void Runner::Implementation::refuse_requests(const std::string& error)
{
  if (step_request != nullptr)
  {
    step_request->error = error;
    step_request->done = true;
    step_request = nullptr;
  }
  if (switch_request != nullptr)
  {
    switch_request->error = error;
    switch_request->done = true;
    switch_request = nullptr;
  }
  wake.notify_all();
}

void Runner::Implementation::loop()
{
  clock.restart(time());
  for (;;)
  {
    StepRequest* request = nullptr;
    bool reset = false;
    bool rest = false;
    {
      std::unique_lock<std::mutex> lock(mutex);
      const auto idle = [&] { return paused || settings.pace == Pace::lock_step; };
      rest = idle();
      wake.wait(lock, [&]
                { return stop || reset_wanted || step_request != nullptr || switch_request != nullptr || !idle(); });
      if (stop)
        return refuse_requests("the runner is being stopped");
      if (switch_request != nullptr)
      {
        serve_switch(*switch_request);
        if (idle())
          continue;
      }
      std::swap(reset, reset_wanted);
      request = step_request;
    }
    if (reset)
    {
      solver->reset();
      if (guard)
        guard->restart();
      frame.failed = false;
      frame.failure.clear();
      clock.restart(0);
      publish(true);
      const std::lock_guard<std::mutex> lock(mutex);
      ++resets_done;
    }
    else if (request != nullptr)
    {
      serve_step(*request);
      const std::lock_guard<std::mutex> lock(mutex);
      request->done = true;
      step_request = nullptr;
      cancel_wanted = false;
    }
    else
    {
      if (rest)
        clock.restart(time());
      run_frame();
      continue;
    }
    wake.notify_all();
  }
}

// whatever a backend or a listener throws ends the motion, not the process
void Runner::Implementation::guarded_loop()
{
  for (;;)
    try
    {
      loop();
      return;
    }
    catch (const std::exception& error)
    {
      frame.failed = true;
      frame.failure = error.what();
      std::unique_lock<std::mutex> lock(mutex);
      refuse_requests(frame.failure);
      ++resets_done;  // a reset that failed must not keep its caller waiting
      wake.wait_for(lock, std::chrono::milliseconds(100), [&] { return stop || reset_wanted; });
    }
}

Runner::Runner(std::shared_ptr<const Model> model, const RunnerSettings& settings, OnFrame on_frame)
    : self_(std::make_unique<Implementation>())
{
  self_->model = std::move(model);
  self_->settings = settings;
  if (!(self_->settings.frame_rate > 0))
    self_->settings.frame_rate = self_->model->frame_rate;
  if (!(self_->settings.frame_rate >= 0.1 && self_->settings.frame_rate <= 1000))
    throw Error("frame rate " + std::to_string(self_->settings.frame_rate) + " Hz: allowed is 0.1 to 1000");
  self_->on_frame = std::move(on_frame);
  self_->solver = make_solver(self_->model, settings.solver);
  if (settings.guard)
    self_->guard = std::make_unique<Guard>(*self_->solver, self_->model, *settings.guard);
  self_->target = self_->solver->controls();
  self_->effects = self_->solver->effects();
  self_->thread = std::thread([this] { self_->guarded_loop(); });
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

void Runner::set_activation(const std::map<std::string, double>& activation)
{
  const std::lock_guard<std::mutex> lock(self_->mutex);
  set_activations(*self_->model, activation, self_->target.activation);
}

void Runner::set_expression(const std::string& name)
{
  const std::vector<float> activation = expression_activation(*self_->model, name);
  const std::lock_guard<std::mutex> lock(self_->mutex);
  self_->target.activation = activation;
}

void Runner::set_bone(const std::string& name, const RigidTransform& motion)
{
  const std::lock_guard<std::mutex> lock(self_->mutex);
  set_bone_motion(*self_->model, name, motion, self_->target.bone);
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
  self_->reset_wanted = true;
  self_->wake.notify_all();
  const auto before = self_->resets_done;
  self_->wake.wait(lock, [&] { return self_->resets_done != before || self_->stop; });
}

void Runner::cancel_step()
{
  const std::lock_guard<std::mutex> lock(self_->mutex);
  self_->cancel_wanted = self_->step_request != nullptr;
}

Frame Runner::step(double seconds)
{
  if (!(seconds > 0) || !std::isfinite(seconds))
    throw Error("step of " + std::to_string(seconds) + " s: allowed are finite durations above 0");
  const std::lock_guard<std::mutex> one_at_a_time(self_->step_mutex);
  Implementation::StepRequest request;
  request.seconds = seconds;
  std::unique_lock<std::mutex> lock(self_->mutex);
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
