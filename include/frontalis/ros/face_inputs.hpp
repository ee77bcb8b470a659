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
#include <sensor_msgs/JointState.h>
#include <trajectory_msgs/JointTrajectory.h>

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <vector>

namespace frontalis
{

/// The topics that move a face (doc/ros.md). The latest writer of a muscle has it, whatever its topic. Messages with a
/// fault are refused as a whole, with one warning per series. Any thread may call these functions.
class FaceInputs
{
public:
  /// Gives the runner, or null and the reason why there is none.
  using FindRunner = std::function<std::shared_ptr<Runner>(std::string* reason)>;

  /// Subscribes. `now`: the simulated time of the latest frame [s].
  FaceInputs(ros::NodeHandle private_handle, const std::string& name, FindRunner runner, std::function<double()> now);
  /// No callback begins any more.
  void shutdown();

  /// Takes a model without any command. Reads the table of blendshapes; throws an Error if that has a fault.
  void start(const std::shared_ptr<const Model>& model, const InputParameters& parameters,
             const std::string& face_frame);
  /// Changes what may change while the face runs; not the table of blendshapes and the followed frames.
  void configure(const InputParameters& parameters);
  /// Resets the face, and forgets all commands.
  void reset(Runner& running);

  /// Commands muscles, as a message on this topic or from this source; if there is a fault, it is reported like that of
  /// a message, and nothing changes.
  void set(const char* topic, const ros::Time& stamp, const std::vector<std::string>& names,
           const std::vector<double>& values);
  /// Sets what the demo, the commands and the followed frames have for a simulated time [s].
  void play(Runner& running, double time);
  /// The expression that the demo shows at a simulated time [s]; empty if no demo plays.
  std::string shown_expression(double time) const;
  /// Whether the activations may change after a time [s] without a further command.
  bool timed(double time) const;
  /// The activations that are commanded for a time [s].
  std::map<std::string, double> target(double time) const;

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
  /// runner, its stamp is not close to the present, or `act` throws.
  template <typename Act>
  void take(const char* topic, const ros::Time& stamp, const Act& act);
  void command(const char* topic, Runner& running, double now,
               const std::map<std::string, MuscleCommands::Course>& courses, double begin);
  /// Durations [s]: to reach a pose, to keep it (0: until the next command), to relax after that.
  struct Timing
  {
    double onset = 0, hold = 0, release = 0;
  };
  /// Commands all muscles, and the bones that expressions or action units of the model move.
  void take_pose(const char* topic, Runner& running, double now, const Controls& pose, const Timing& timing);
  void set_bones(Runner& running, double time) const;
  Controls present_bones(double time) const;
  std::map<std::string, double> present(double time) const;
  void check_stamp(const ros::Time& stamp) const;
  void end_demo(const char* topic);

  const std::string name_;
  const FindRunner runner_;
  const std::function<double()> now_;
  std::vector<ros::Subscriber> subscribers_;

  mutable std::mutex mutex_;  ///< protects all below; held while the runner's controls are set
  std::shared_ptr<const Model> model_;
  InputParameters parameters_;
  std::unique_ptr<DemoPlayer> demo_;
  bool demo_playing_ = false;
  std::unique_ptr<MuscleCommands> commands_;
  ControlCurve bones_;           ///< motions of bones by the latest pose; empty: none
  std::set<std::string> posed_;  ///< bones that move by it
  bool silent_ = false;          ///< the watchdog relaxes the face, or has done so
  std::unique_ptr<BlendshapeTable> blendshapes_;
  std::set<std::string> lacking_;  ///< blendshapes that were reported
  std::unique_ptr<BoneFollower> follower_;
  double followed_ = 0;  ///< simulated time of the latest look at followed frames
  struct Topic
  {
    std::uint64_t taken = 0, refused = 0;
    bool warned = false;  ///< about the present series of refused messages
    std::string reason;   ///< of the latest refusal
  };
  std::map<std::string, Topic> topics_;
};

}  // namespace frontalis
