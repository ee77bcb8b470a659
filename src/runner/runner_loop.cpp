#include "frontalis/error.hpp"
#include "frontalis/runner/face_frame.hpp"
#include "frontalis/solver/rigid_motion.hpp"
#include "runner/runner_implementation.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

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
  if (!frame.failed && (renew_monitor || now - last_monitor > std::chrono::seconds(1)))
  {
    const Monitor monitor = solver->monitor();
    last_monitor = now;
    frame.failed = !monitor.finite;
    if (frame.failed)
      frame.failure = "the motion is no longer finite";
    else
      frame.monitor = monitor;
  }
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
    else if (switch_request != nullptr)
      serve_switch(*switch_request);
  }
  publish(true);
  request.frame = frame;
}

// under the mutex
void Runner::Implementation::serve_switch(SwitchRequest& request)
{
  try
  {
    // else a state gone bad since the latest check would become the one to go back to
    if (guard && !frame.failed)
      guard->check();
  }
  catch (const Error& error)
  {
    frame.failed = true;
    frame.failure = error.what();
  }
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
  cancel_wanted = false;
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
      reset_error.clear();
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
      reset_error = frame.failure;
      ++resets_done;  // a reset that failed must not keep its caller waiting
      wake.wait_for(lock, std::chrono::milliseconds(100), [&] { return stop || reset_wanted; });
    }
}

}  // namespace frontalis
