#pragma once

#include "runner/frame_clock.hpp"
#include "frontalis/runner/runner.hpp"
#include "frontalis/solver/fine_lines.hpp"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

namespace frontalis
{

/// The runner's state. runner.cpp has the functions that callers' threads run, runner_loop.cpp those of the runner's
/// own thread.
struct Runner::Implementation
{
  using Clock = std::chrono::steady_clock;

  std::shared_ptr<const Model> model;
  RunnerSettings settings;
  std::atomic<double> frame_rate{ 30 };  ///< [1/s] of wall time
  std::atomic<double> damping{ 0 };      ///< [1/s]
  OnFrame on_frame;
  std::unique_ptr<Solver> solver;
  std::unique_ptr<Guard> guard;           ///< null: the motion is not checked
  std::unique_ptr<FineLines> fine_lines;  ///< null: the skin has no fine lines

  // The following members are shared with the callers' threads and protected by the mutex.
  mutable std::mutex mutex;
  std::condition_variable wake;
  Controls target;
  bool stop = false;
  bool paused = false;
  bool cancel_wanted = false;  ///< ends the call of step() that is under way
  /// Numbers of calls of reset(): all, those whose reset has begun, and those whose reset is over, also if it failed.
  std::uint64_t resets_wanted = 0, resets_begun = 0, resets_done = 0;
  std::string reset_error;  ///< why the latest reset failed; empty if it succeeded
  struct StepRequest
  {
    double seconds = 0;
    bool hands_out = true;  ///< whether the frame reached goes to on_frame
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
  std::mutex switch_mutex;  ///< held while an effect is switched, so that there is one request at a time

  // The following members are used by the runner's thread alone.
  Frame frame;
  FrameClock clock;
  Clock::time_point deadline{};  ///< wall time at which the present frame ends
  Clock::time_point start = Clock::now();
  Clock::time_point last_monitor{};
  Clock::time_point last_told{};  // when progress or a frame was last handed out, or a wait for a frame ended
  Profile last_profile;           ///< of the solver at the latest renewal of the monitor
  std::thread thread;

  bool reset_wanted() const { return resets_wanted > resets_begun; }
  /// Time of the clock that the face follows [s].
  double now() const
  {
    return settings.clock ? settings.clock() : std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
  }
  /// Wall time per frame [s].
  double period() const { return 1 / frame_rate; }
  /// Simulated time multiplied by Model::time_scaling, the time of activations and frames [s].
  double time() const { return solver->time() * model->time_scaling; }
  /// Simulated duration of a slice [s]. The wall clock is not looked at within a slice.
  double slice() const;

  bool advance(double seconds, const Controls& controls, const std::function<bool()>& interrupted);
  Controls controls_after(double seconds) const;
  void fail(const std::string& reason);
  void measure_cost();
  // Writes the present time, activations and counts of steps into the frame.
  void note_progress();
  void make_frame(bool renew_monitor);
  void publish(bool renew_monitor = false, bool hands_out = true);
  void run_frame();
  void serve_step(StepRequest& request);
  void serve_switch(std::unique_lock<std::mutex>& lock);
  void refuse_requests(const std::string& error);
  void reset();
  void serve_until_stopped();
  void run();
};

}  // namespace frontalis
