#pragma once

#include "frontalis/ros/blendshapes.hpp"
#include "frontalis/ros/bone_follower.hpp"
#include "frontalis/ros/demo_player.hpp"
#include "frontalis/ros/muscle_commands.hpp"
#include "frontalis/ros/parameters.hpp"
#include "frontalis/runner/named_controls.hpp"
#include "frontalis/runner/runner.hpp"

#include <diagnostic_updater/DiagnosticStatusWrapper.h>
#include <frontalis/ActionUnits.h>
#include <frontalis/Blendshapes.h>
#include <frontalis/Expression.h>
#include <frontalis/MuscleActivation.h>
#include <geometry_msgs/TransformStamped.h>
#include <ros/node_handle.h>
#include <ros/time.h>
#include <sensor_msgs/JointState.h>
#include <trajectory_msgs/JointTrajectory.h>

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace frontalis
{

/// The topics that move a face (doc/ros.md). A muscle follows its latest command, whatever the topic. A message with a
/// fault is refused as a whole; a warning is logged when a series of such messages begins or has another reason. Any
/// thread may call these functions.
class FaceInputs
{
public:
  /// Returns the runner, or null and the reason why there is none.
  using FindRunner = std::function<std::shared_ptr<Runner>(std::string* reason)>;

  /// Subscribes to the topics. `now` returns the simulated time of the latest frame [s].
  FaceInputs(ros::NodeHandle private_handle, const std::string& name, FindRunner runner, std::function<double()> now);
  /// Unsubscribes: after this no callback begins.
  void shutdown();

  /// Starts with a new model and no commands. Reads the table of blendshapes; throws an Error if the table has a fault.
  void start(const std::shared_ptr<const Model>& model, const InputParameters& parameters,
             const std::string& face_frame);
  /// Changes the parameters while the face runs, except the table of blendshapes and the followed frames.
  void configure(const InputParameters& parameters);
  /// Resets the face, and forgets all commands.
  void reset(Runner& running);

  /// Commands muscles as a message on `topic` would; `topic` may also name another source. A fault is reported like the
  /// fault of a message, and nothing changes. Returns the fault; empty if there is none.
  std::string set(const char* topic, const ros::Time& stamp, const std::vector<std::string>& names,
                  const std::vector<double>& values);
  /// Sets the runner's activations and bones to those of the demo, the commands and the followed frames at a time [s],
  /// or at the present one. A reset that is under way is over before the present time is asked for.
  void play(Runner& running, double time);
  void play(Runner& running);
  /// The expression that the demo shows at a simulated time [s]; empty if no demo plays.
  std::string shown_expression(double time) const;
  /// Whether the activations may change after a time [s] without a further command.
  bool timed(double time) const;
  /// The activations that are commanded for a simulated time [s].
  std::map<std::string, double> target(double time) const;

  /// Number of messages that were taken or refused.
  std::uint64_t messages() const;
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) const;

private:
  void on_muscle_activation(const MuscleActivation& message);
  void on_joint_states(const sensor_msgs::JointState& message);
  void on_joint_trajectory(const trajectory_msgs::JointTrajectory& message);
  void on_action_units(const ActionUnits& message);
  void on_blendshapes(const Blendshapes& message);
  void on_expression(const Expression& message);
  void on_bone_pose(const geometry_msgs::TransformStamped& message);

  /// Calls `act` with the runner and the simulated time, with the mutex locked; refuses the message if there is no
  /// runner, another face is taking its place, its stamp is not close to the present, or `act` throws. Returns the
  /// reason of a refusal.
  template <typename Act>
  std::string take(const char* topic, const ros::Time& stamp, const Act& act);
  /// `bones_end`: time at which bones reach the end of their motion; without, a motion under way goes on.
  void command(const char* topic, Runner& running, double now,
               const std::map<std::string, MuscleCommands::Course>& courses, double begin,
               std::optional<double> bones_end = std::nullopt);
  /// Durations [s]: to reach a pose, to hold it (0: until the next command), and to relax after that.
  struct Timing
  {
    double onset = 0, hold = 0, release = 0;
  };
  /// Commands all muscles, and the bones that expressions or action units of the model move.
  void take_pose(const char* topic, Runner& running, double now, const Controls& pose, const Timing& timing);
  void play_at(Runner& running, double time);
  void set_bones(Runner& running, double time) const;
  Controls present_bones(const Runner& running, double time) const;
  std::map<std::string, double> present(double time) const;
  void check_stamp(const ros::Time& stamp) const;
  void end_demo(const char* topic);

  const std::string name_;
  const FindRunner runner_;
  const std::function<double()> now_;
  std::vector<ros::Subscriber> subscribers_;

  mutable std::mutex mutex_;  ///< protects all members below; held while the runner's controls are set
  std::shared_ptr<const Model> model_;
  std::string face_frame_;
  InputParameters parameters_;
  std::unique_ptr<DemoPlayer> demo_;
  bool demo_playing_ = false;
  std::unique_ptr<MuscleCommands> commands_;
  ControlCurve bones_;           ///< motions of bones that the latest pose commands; empty: none
  std::set<std::string> posed_;  ///< bones that `bones_` moves
  bool silent_ = false;          ///< the watchdog relaxes the face, or has done so
  std::unique_ptr<BlendshapeTable> blendshapes_;
  std::set<std::string> lacking_;  ///< blendshapes that move nothing of the model and were reported
  std::unique_ptr<BoneFollower> follower_;
  double followed_ = 0;  ///< simulated time of the latest call of follower_ [s]
  struct Topic
  {
    std::uint64_t taken = 0, refused = 0;
    bool warned = false;  ///< whether the present series of refused messages was warned about
    std::string reason;   ///< reason of the latest refusal
    std::string told;     ///< reason that the latest warning gave
    ros::WallTime told_at;
  };
  std::map<std::string, Topic> topics_;
};

}  // namespace frontalis
