#pragma once

#include "frontalis/runner/face_frame.hpp"
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

/// The state of a face that is published once per frame. Positions are in the face frame [m].
struct Frame
{
  double time = 0;       ///< simulated time since the latest reset, multiplied by Model::time_scaling [s]
  double wall_time = 0;  ///< wall time since the runner started [s]
  /// simulated time divided by wall time, or by the time of RunnerSettings::clock, over about the last second
  double real_time_factor = 0;
  double time_step = 0;        ///< of the solver [s]
  std::int64_t steps = 0;      ///< solver steps since the latest reset
  std::uint64_t sequence = 0;  ///< number of the frame
  SkinState skin;
  std::vector<float> field;  ///< requested by RunnerSettings::wanted_field, per skin vertex; empty if none
  /// Displacements of the nodes in the local frame [m], while RunnerSettings::wants_displacements; else empty.
  std::vector<std::array<double, 3>> displacements;
  std::vector<BodyFrame> bodies;  ///< rigid bodies, one per entry of touched_bodies(model)
  std::vector<BodyFrame> bones;   ///< one per bone
  /// whether RunnerSettings::wants_bone_forces was true; otherwise reactions of bones are 0
  bool has_bone_forces = false;
  SkinField kind_of_field = SkinField::strain;  ///< what `field` contains
  std::vector<float> activation;                ///< present activation of each muscle, 0..1
  Monitor monitor;               ///< energies and volume ratios, renewed about once per second of wall time
  double seconds_per_step = 0;   ///< wall time per step since the latest renewal of the monitor; 0: not known
  std::size_t solver_bytes = 0;  ///< memory of the solver's arrays, without the model
  GuardCounts guard;             ///< since the runner started
  bool failed = false;           ///< true: the motion was stopped; the skin is the last one without a fault
  std::string failure;           ///< the reason, in one sentence
};

constexpr double slowest_frame_rate = 0.1, fastest_frame_rate = 1000;  ///< limits of the frames per second of wall time

enum class Pace
{
  real_time,  ///< not faster than the wall clock, or than RunnerSettings::clock
  fastest,    ///< as fast as the machine can
  lock_step   ///< the face moves only in step()
};

struct RunnerSettings
{
  SolverSettings solver;
  Pace pace = Pace::real_time;
  double frame_rate = 0;  ///< frames per second of wall time, 0.1 to 1000; 0: the model's
  std::optional<GuardSettings> guard = GuardSettings{};  ///< empty: the motion is not checked
  /// The clock [s] that a face at the pace of real time follows instead of the wall clock. It may stand still, go at
  /// any speed and jump. Called in the runner's thread.
  std::function<double()> clock{};
  /// Called once per frame in the runner's thread; returns the field of the skin to compute. If the function is not set
  /// or returns nothing, no field is computed.
  std::function<std::optional<SkinField>()> wanted_field{};
  /// Called once per frame in the runner's thread. If it is not set or returns false, no displacements are copied.
  std::function<bool()> wants_displacements{};
  /// Called once per frame in the runner's thread. If it is not set or returns false, forces on bones are not computed.
  std::function<bool()> wants_bone_forces{};
  /// Called in the runner's thread while it computes a frame, 55 times per second of wall time at the most. The frame
  /// has the present time, activations and counts of steps; all else is as in the frame handed out last.
  std::function<void(const Frame&)> on_progress{};
  /// Called every few dozen time steps of a step() in the runner's thread. If it returns true, the step ends as if
  /// cancel_step() had been called.
  std::function<bool()> ends_steps{};
};

/// A face that moves by itself: it owns the solver and a thread that steps it and hands out frames. All functions may
/// be called from any thread.
class Runner
{
public:
  /// Called once per frame in the runner's thread. It may call the runner's const functions only.
  using OnFrame = std::function<void(const Frame&)>;

  Runner(std::shared_ptr<const Model> model, const RunnerSettings& settings, OnFrame on_frame);
  ~Runner();
  Runner(const Runner&) = delete;
  Runner& operator=(const Runner&) = delete;

  /// Sets activations (0..1) by the names of muscles; other muscles keep theirs. If a name is unknown or a value is not
  /// within 0..1, nothing is changed and an Error names all of them.
  void set_activation(const std::map<std::string, double>& activation);
  /// Sets a named expression of the model (named_controls.hpp): all activations, and the motions of the bones that any
  /// expression moves. Throws an Error that lists the existing names if the name is unknown.
  void set_expression(const std::string& name);

  /// Sets the motion of a bone from its rest pose, in the face frame. The bone moves there within about a frame, but at
  /// most 1/30 s, as activations do. If there is no such bone, or the motion is not finite and rigid, nothing is
  /// changed and an Error is thrown.
  void set_bone(const std::string& name, const RigidTransform& motion);
  /// The motions to which bones move, in the order of the model's bones, from rest in the model's frame.
  std::vector<RigidTransform> bones() const;

  /// Switches an effect off or on between two frames and returns when the switch is done. Throws the Errors of
  /// Solver::switch_effect.
  void switch_effect(Effect effect, bool on);
  EffectSet effects() const;

  /// Changes the number of frames per second of wall time, 0.1 to 1000; 0: that of the model. Throws an Error if it is
  /// out of range.
  void set_frame_rate(double rate);
  double frame_rate() const;

  /// Changes the damping (frontalis/solver/damping.hpp) between two time steps; below 0: that of the model. Throws an
  /// Error if it is not finite.
  void set_damping(double damping);

  void pause(bool paused);
  bool paused() const;
  /// Puts the tissue and the bones back to rest and sets all activations and the time to 0. Clears a failure, and ends
  /// a call of step() that is under way. Returns when the reset is done; throws an Error if the solver fails to reset.
  void reset();
  /// Ends a call of step() that is under way; its caller gets an Error.
  void cancel_step();
  /// Pauses the face, advances it by exactly `seconds` of simulated time and returns the frame reached. Activations and
  /// bones move linearly to their latest set values. Throws an Error if the motion fails, if the step is ended early,
  /// or if another step is under way. With `hands_out` false, OnFrame gets the frame only if the motion fails.
  Frame step(double seconds, bool hands_out = true);

  const Model& model() const;
  std::string description() const;

private:
  struct Implementation;
  std::unique_ptr<Implementation> self_;
};

}  // namespace frontalis
