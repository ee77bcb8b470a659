#pragma once

#include "frontalis/solver/guard.hpp"
#include "frontalis/solver/solver.hpp"

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace frontalis
{

/// One published skin: everything in the face frame [m].
struct Frame
{
  double time = 0;              ///< simulated seconds since reset, on the clock on which activations are given
  double wall_time = 0;         ///< seconds spent since the runner started
  double real_time_factor = 0;  ///< simulated over wall seconds, over the last second of running
  double time_step = 0;         ///< [s]
  std::int64_t steps = 0;       ///< since reset
  std::uint64_t sequence = 0;
  SkinState skin;
  std::vector<float> field;  ///< as RunnerSettings::wanted_field had it; else empty
  std::vector<float> activation;
  Monitor monitor;      ///< renewed about once a second
  GuardCounts guard;    ///< since the runner started
  bool failed = false;  ///< the motion could not be trusted; the skin is the last good one
  std::string failure;  ///< why, in one sentence
};

enum class Pace
{
  real_time,  ///< never faster than the clock
  fastest,    ///< as fast as it can
  lock_step   ///< only on step()
};

struct RunnerSettings
{
  SolverSettings solver;
  Pace pace = Pace::real_time;
  double frame_rate = 0;                                 ///< frames a wall second, 0.1 to 1000; 0: the model's
  std::optional<GuardSettings> guard = GuardSettings{};  ///< none: the motion is not watched
  /// Asked once a frame, in the runner's thread; where it is not set or has none, no field is computed.
  std::function<std::optional<SkinField>()> wanted_field{};
};

/// A live face: owns the solver and a thread that steps it, takes controls from any thread, hands out frames.
class Runner
{
public:
  /// Called in the runner's thread, once a frame; must not call back into the runner but to read.
  using OnFrame = std::function<void(const Frame&)>;

  Runner(std::shared_ptr<const Model> model, const RunnerSettings& settings, OnFrame on_frame);
  ~Runner();
  Runner(const Runner&) = delete;
  Runner& operator=(const Runner&) = delete;

  /// Activations by muscle name, 0..1; muscles not named keep theirs. Throws Error naming each unknown muscle or bad
  /// value (not finite, out of range); nothing is changed then.
  void set_activation(const std::map<std::string, double>& activation);
  /// A named preset of the model; muscles that it does not name go to 0. Throws Error listing those that exist.
  void set_expression(const std::string& name);

  /// Motion of a bone from its rest pose, in the face frame; reached within a frame, as activations are. Throws Error
  /// where there is no such bone or the motion is not finite and rigid; nothing is changed then.
  void set_bone(const std::string& name, const RigidTransform& motion);

  /// Switches an effect when the frame under way is done, and returns then. Throws Error as Solver::switch_effect.
  void switch_effect(Effect effect, bool on);
  /// Effects that run.
  EffectSet effects() const;

  void pause(bool paused);
  bool paused() const;
  /// Back to rest, zero activation and bones in place; clears a failure, ends a step under way. Returns when it is
  /// done; throws Error where the solver fails in it.
  void reset();
  /// Ends a step under way: its caller gets an Error.
  void cancel_step();
  /// Advances by exactly `seconds` (on the activations' clock), activations going linearly to what was set last, and
  /// returns the frame there; pauses the runner's own stepping first. Throws Error, also where another step is under
  /// way.
  Frame step(double seconds);

  const Model& model() const;
  std::string description() const;

private:
  struct Implementation;
  std::unique_ptr<Implementation> self_;
};

}  // namespace frontalis
