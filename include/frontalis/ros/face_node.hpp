#pragma once

#include "frontalis/ros/demo_player.hpp"
#include "frontalis/ros/face_publisher.hpp"
#include "frontalis/ros/parameters.hpp"
#include "frontalis/runner/runner.hpp"

#include <diagnostic_updater/diagnostic_updater.h>
#include <frontalis/ListMuscles.h>
#include <frontalis/MuscleActivation.h>
#include <frontalis/Step.h>
#include <frontalis/SwitchEffect.h>
#include <geometry_msgs/TransformStamped.h>
#include <ros/node_handle.h>
#include <sensor_msgs/JointState.h>
#include <std_msgs/String.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace frontalis
{

/// The ROS interface of one simulated face (doc/ros.md): the topics, services, transforms and diagnostics of a Runner.
/// A thread of its own bakes or reads the model. Bad parameters and failed bakes are logged once and shown in
/// /diagnostics; the services then answer with a failure. Several threads may run the callbacks at the same time.
class FaceNode
{
public:
  /// `name` is the name of the face in log messages and diagnostics.
  FaceNode(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle, const std::string& name);
  ~FaceNode();
  FaceNode(const FaceNode&) = delete;
  FaceNode& operator=(const FaceNode&) = delete;

private:
  // the thread that loads the model
  void load();
  std::shared_ptr<const Model> make_model(const FaceParameters& parameters);

  // the runner's thread
  void on_frame(const Frame& frame);
  void log_speed_once();

  // inputs
  void set_activation(const char* topic, const std::vector<std::string>& names, const std::vector<double>& values);
  void on_muscle_activation(const MuscleActivation& message);
  void on_joint_states(const sensor_msgs::JointState& message);
  void on_expression(const std_msgs::String& message);
  void on_bone_pose(const geometry_msgs::TransformStamped& message);
  /// Calls `act` with the runner. Logs a warning if there is no runner yet or if `act` throws an Error.
  template <typename Act>
  void take_message(const char* topic, const Act& act);
  void refuse(const char* topic, const std::string& reason);
  void end_demo(const char* topic);

  // services
  /// Calls `act` with the runner. The response is a failure with the reason if there is no runner yet or if `act`
  /// throws an Error.
  template <typename Response, typename Act>
  bool answer(Response& response, const Act& act);
  bool on_reset(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool on_pause(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response);
  bool on_step(Step::Request& request, Step::Response& response);
  bool on_switch_effect(SwitchEffect::Request& request, SwitchEffect::Response& response);
  bool on_list_muscles(ListMuscles::Request& request, ListMuscles::Response& response);

  // timers
  void repeat_frame_and_play_demo();
  void play_demo(double time);
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);

  /// The runner; null while there is no model, and then the reason is written to `reason`.
  std::shared_ptr<Runner> runner(std::string* reason = nullptr) const;

  ros::NodeHandle handle_, private_handle_;
  const std::string name_;
  diagnostic_updater::Updater updater_;

  mutable std::mutex runner_mutex_;  ///< protects the members up to parameters_
  std::shared_ptr<Runner> runner_;
  std::shared_ptr<const DemoPlayer> demo_;
  std::string load_fault_;
  std::string loading_stage_ = "starting";
  FaceParameters parameters_;

  std::mutex frame_mutex_;  ///< protects the members up to last_published_; never held while the runner is called
  FacePublisher publisher_;
  Frame frame_;  ///< the latest frame
  bool has_frame_ = false;
  bool frame_finite_ = true;
  std::uint64_t frames_dropped_ = 0;
  std::string speed_report_;      ///< as it was logged; empty if it was not logged yet
  ros::WallTime last_frame_;      ///< when the runner made the latest frame
  ros::WallTime last_published_;  ///< when a frame was published the last time, new or repeated

  std::mutex target_mutex_;  ///< protects target_ and demo_playing_; held while the runner's activations are set too
  std::map<std::string, double> target_;  ///< activation of each muscle as last commanded
  bool demo_playing_ = false;

  std::atomic<bool> paused_{ false };
  std::atomic<bool> stopping_{ false };
  std::vector<ros::Subscriber> subscribers_;
  std::vector<ros::ServiceServer> services_;
  ros::WallTimer frame_timer_, diagnostics_timer_;
  std::thread loader_;
};

}  // namespace frontalis
