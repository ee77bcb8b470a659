#include "frontalis/error.hpp"
#include "frontalis/model/effects.hpp"
#include "frontalis/runner/face_frame.hpp"
#include "frontalis/runner/named_controls.hpp"
#include "frontalis/solver/damping.hpp"
#include "frontalis/solver/rigid_motion.hpp"
#include "runner/runner_implementation.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

// Time steps per slice. There are few enough that requests do not wait long, and enough that reading the clock and
// locking the mutex once per slice cost little.
constexpr int steps_per_slice = 16;
// Wall time after a frame before progress is told: somewhat less than a fiftieth of a second.
constexpr std::chrono::milliseconds progress_period(18);
constexpr double coarsest_clock = 0.5;         // longest time in which a clock of RunnerSettings may stand still [s]
constexpr double longest_approach = 1.0 / 30;  // time in which controls approach their targets at the most [s]
// Wall time between two computations of the energies and volume ratios.
constexpr std::chrono::seconds monitor_period(1);

// Whether the difference between two poses of a bone is too small to be seen: below 1e-5 rad and 1e-6 m.
bool nearly_equal(const RigidTransform& a, const RigidTransform& b)
{
  const auto within = [](double limit) { return [limit](double x, double y) { return std::abs(x - y) < limit; }; };
  return std::equal(a.rotation.begin(), a.rotation.end(), b.rotation.begin(), within(1e-5)) &&
         std::equal(a.translation.begin(), a.translation.end(), b.translation.begin(), within(1e-6));
}

constexpr const char* ended_early = "the step was ended early";

// Ends a request, if there is one, with an error for its caller.
template <class Request>
void refuse(Request*& request, const std::string& error)
{
  if (request == nullptr)
    return;
  request->error = error;
  request->done = true;
  request = nullptr;
}

}  // namespace

double Runner::Implementation::slice() const { return steps_per_slice * solver->time_step() * model->time_scaling; }

void Runner::Implementation::fail(const std::string& reason)
{
  frame.failed = true;
  frame.failure = reason;
}

// Advances the face by `seconds` of the time that time() returns. If the motion fails, the face stops until it is
// reset. Returns false if the motion was ended early, because `interrupted`, which is called with the mutex held, was
// true: an unstable motion may take minutes.
bool Runner::Implementation::advance(double seconds, const Controls& controls, const std::function<bool()>& interrupted)
{
  try
  {
    frontalis::set_damping(*solver, damping);
    const auto go_on = [&]
    {
      const std::lock_guard<std::mutex> lock(mutex);
      return !interrupted();
    };
    seconds /= model->time_scaling;
    return guard ? guard->advance(seconds, controls, go_on) : solver->advance(seconds, controls, go_on);
  }
  catch (const Error& error)
  {
    fail(error.what());
    return true;
  }
}

void Runner::Implementation::measure_cost()
{
  const Profile profile = solver->profile();
  // A reset sets the solver's profile to 0.
  const Profile since = profile.steps < last_profile.steps ? Profile{} : last_profile;
  if (profile.steps > since.steps)
    frame.seconds_per_step = (profile.stepping - since.stepping) / static_cast<double>(profile.steps - since.steps);
  last_profile = profile;
  frame.solver_bytes = 0;
  for (const Allocation& allocation : solver->allocations())
    frame.solver_bytes += allocation.bytes;
}

void Runner::Implementation::note_progress()
{
  last_told = Clock::now();
  frame.time = time();
  frame.wall_time = std::chrono::duration<double>(last_told - start).count();
  frame.time_step = solver->time_step();
  frame.steps = solver->profile().steps;
  frame.activation = solver->activation();
}

void Runner::Implementation::make_frame(bool renew_monitor)
{
  const auto now = Clock::now();
  if (!frame.failed && (renew_monitor || now - last_monitor > monitor_period))
  {
    const Monitor monitor = solver->monitor();
    last_monitor = now;
    measure_cost();
    if (monitor.finite)
      frame.monitor = monitor;
    else
      fail("the motion is no longer finite");
  }
  if (!frame.failed)
  {
    SkinState skin;
    solver->skin(skin);
    // The frame of a step or of a reset waits for its own fine lines, because the face may stand still after it.
    if (fine_lines)
      fine_lines->add_to(skin, renew_monitor);
    if (is_finite(skin))
    {
      to_face_frame(*model, skin);
      frame.skin = std::move(skin);
      const auto field = settings.wanted_field ? settings.wanted_field() : std::nullopt;
      frame.kind_of_field = field.value_or(frame.kind_of_field);
      if (field == SkinField::lines && fine_lines)
        frame.field = frame.skin.line_height;
      else if (field && presence_of(*model, Effect::output_fields).present)
        solver->skin_field(*field, frame.field);
      else
        frame.field.clear();
      frame.displacements.clear();
      if (settings.wants_displacements && settings.wants_displacements())
        solver->displacements(frame.displacements);
    }
    else
      fail("the skin is no longer finite");
  }
  note_progress();
  if (!frame.failed)
  {
    frame.bodies = bodies_in_face_frame(*solver, *model);
    frame.has_bone_forces = settings.wants_bone_forces && settings.wants_bone_forces();
    frame.bones = bones_in_face_frame(*solver, *model, frame.has_bone_forces);
  }
  if (guard)
    frame.guard = guard->counts();
  ++frame.sequence;
}

void Runner::Implementation::publish(bool renew_monitor, bool hands_out)
{
  frame.real_time_factor = clock.record_frame(now(), time());
  make_frame(renew_monitor);
  if (on_frame && (hands_out || frame.failed))
    on_frame(frame);
}

// Controls at the end of the next slice. They approach their targets gradually, so that they do not jump within a time
// step: by 95 % (1 - exp(-3)) per frame, or per `longest_approach` if frames are rare.
Controls Runner::Implementation::controls_after(double seconds) const
{
  Controls next = target;
  const Controls& now = solver->controls();
  const double approach = std::min(period(), longest_approach);
  const auto share = std::min(1.0f, 3 * static_cast<float>(std::min(1.0, seconds / approach)));
  for (std::size_t m = 0; m < next.activation.size(); ++m)
  {
    const float difference = next.activation[m] - now.activation[m];
    if (std::abs(difference) >= 1e-4f)
      next.activation[m] = now.activation[m] + share * difference;
  }
  for (std::size_t b = 0; b < next.bone.size(); ++b)
    if (!nearly_equal(now.bone[b], next.bone[b]))
      next.bone[b] = interpolate(now.bone[b], next.bone[b], share);
  return next;
}

// Makes steps until the frame's simulated time is reached or its wall time is over, and publishes the frame.
void Runner::Implementation::run_frame()
{
  const auto length = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(period()));
  // Deadlines follow a fixed schedule, so that late frames do not make the next ones late. Each frame has at least a
  // quarter of its length; frames that were missed completely are skipped.
  deadline = std::max(deadline + length, Clock::now() + length / 4);
  deadline = std::min(deadline, Clock::now() + length);
  const double most_behind = std::max(settings.clock ? coarsest_clock : 0, 2 * period());
  const double end =
      time() + (settings.pace == Pace::fastest ? 1e9 : clock.behind(now(), time(), most_behind) + period());
  const auto interrupted = [this] { return stop || paused || reset_wanted() || step_request != nullptr; };
  // A frame has one slice at the least, so that a face that steps slowly is still seen to move.
  for (bool is_first = true; !frame.failed && time() < end && (is_first || Clock::now() < deadline); is_first = false)
  {
    const double seconds = std::min(end - time(), slice());
    Controls controls;
    {
      std::unique_lock<std::mutex> lock(mutex);
      if (interrupted())
      {
        // The face stands still, so that its latest frame must not be of an earlier time.
        const bool is_late = !is_first && paused && !stop;
        lock.unlock();
        if (is_late)
          publish();
        return;
      }
      controls = controls_after(seconds);
    }
    advance(seconds, controls, interrupted);
    if (!frame.failed && settings.on_progress && Clock::now() - last_told > progress_period)
    {
      note_progress();
      settings.on_progress(frame);
    }
  }
  publish();
  std::unique_lock<std::mutex> lock(mutex);
  if (settings.pace != Pace::real_time && !frame.failed)
    return;
  const bool waits = Clock::now() < deadline;
  wake.wait_until(lock, deadline,
                  [&] { return stop || reset_wanted() || step_request != nullptr || switch_request != nullptr; });
  // While a face waits for its next frame, there is no progress to be told.
  if (waits)
    last_told = Clock::now();
}

void Runner::Implementation::serve_step(StepRequest& request)
{
  Controls end;
  {
    const std::lock_guard<std::mutex> lock(mutex);
    end = target;
  }
  if (frame.failed)
    request.error = frame.failure + "; reset first";
  const Controls begin = solver->controls();
  clock.restart(now(), time());
  const auto interrupted = [this]
  { return stop || reset_wanted() || cancel_wanted || (settings.ends_steps && settings.ends_steps()); };
  for (double done = 0; done < request.seconds && request.error.empty();)
  {
    const double seconds = std::min(request.seconds - done, slice());
    done += seconds;
    const bool whole = advance(seconds, interpolate(begin, end, std::min(1.0, done / request.seconds)), interrupted);
    request.error = frame.failure;
    std::unique_lock<std::mutex> lock(mutex);
    if (!whole || interrupted())
      request.error = ended_early;
    else if (switch_request != nullptr)
      serve_switch(lock);
  }
  publish(true, request.hands_out);
  request.frame = frame;
}

// The lock is on the mutex. It is released while the guard checks the state, which can take long.
void Runner::Implementation::serve_switch(std::unique_lock<std::mutex>& lock)
{
  SwitchRequest& request = *switch_request;
  // The state is checked first, so that the guard does not save a state that became unstable since the latest check.
  if (guard && !frame.failed)
  {
    lock.unlock();
    try
    {
      guard->check(
          [this]
          {
            const std::lock_guard<std::mutex> here(mutex);
            return !stop && !reset_wanted() && !cancel_wanted;
          });
    }
    catch (const Error& error)
    {
      fail(error.what());
    }
    lock.lock();
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

// The caller must hold the mutex.
void Runner::Implementation::refuse_requests(const std::string& error)
{
  refuse(step_request, error);
  refuse(switch_request, error);
  cancel_wanted = false;
  wake.notify_all();
}

void Runner::Implementation::reset()
{
  solver->reset();
  if (fine_lines)
    fine_lines->reset();
  if (guard)
    guard->restart();
  frame.failed = false;
  frame.failure.clear();
  clock.restart(now(), 0);
  publish(true);
  const std::lock_guard<std::mutex> lock(mutex);
  reset_error.clear();
  resets_done = resets_begun;
}

void Runner::Implementation::serve_until_stopped()
{
  clock.restart(now(), time());
  for (;;)
  {
    StepRequest* request = nullptr;
    bool reset_now = false, was_idle = false;
    {
      std::unique_lock<std::mutex> lock(mutex);
      const auto idle = [&] { return paused || settings.pace == Pace::lock_step; };
      was_idle = idle();
      wake.wait(lock, [&]
                { return stop || reset_wanted() || step_request != nullptr || switch_request != nullptr || !idle(); });
      if (stop)
        return refuse_requests("the runner is being stopped");
      if (switch_request != nullptr)
      {
        serve_switch(lock);
        if (idle())
          continue;
      }
      reset_now = reset_wanted();
      resets_begun = resets_wanted;
      // This also ends a step() that was requested before the reset but has not begun.
      if (reset_now)
      {
        refuse(step_request, ended_early);
        cancel_wanted = false;
      }
      request = step_request;
    }
    if (reset_now)
      reset();
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
      if (was_idle)
        clock.restart(now(), time());
      run_frame();
      continue;
    }
    wake.notify_all();
  }
}

// An exception from a backend or a listener ends the motion but not the process.
void Runner::Implementation::run()
{
  for (;;)
    try
    {
      serve_until_stopped();
      return;
    }
    catch (const std::exception& error)
    {
      fail(error.what());
      std::unique_lock<std::mutex> lock(mutex);
      refuse_requests(frame.failure);
      if (resets_done != resets_begun)
      {
        reset_error = frame.failure;
        resets_done = resets_begun;
      }
      wake.wait_for(lock, std::chrono::milliseconds(100), [&] { return stop || reset_wanted(); });
    }
}

}  // namespace frontalis
