#pragma once

#include "runner/frame_clock.hpp"
#include "frontalis/runner/runner.hpp"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

namespace frontalis
{

/// The runner's state and what its thread does (runner_loop.cpp); callers' threads come in by runner.cpp.
struct Runner::Implementation
{
  using Clock = std::chrono::steady_clock;

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
  std::string reset_error;  // of the latest; empty: it was done
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
  std::mutex switch_mutex;  // one switch at a time

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

}  // namespace frontalis
