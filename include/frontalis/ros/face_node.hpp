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

/// One simulated face as ROS sees it (doc/ros.md): topics, services, transforms and diagnostics around a Runner. Bakes
/// or reads its model in a thread of its own; bad parameters and failed bakes are logged once and shown in
/// /diagnostics, while the services go on answering. Its callbacks may run in several threads.
class FaceNode
{
public:
  /// `name` is used in log messages and diagnostics.
  FaceNode(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle, const std::string& name);
  ~FaceNode();
  FaceNode(const FaceNode&) = delete;
  FaceNode& operator=(const FaceNode&) = delete;

private:
  // loading, in its own thread
  void load();
  std::shared_ptr<const Model> make_model(const FaceParameters& parameters);

  // the runner's thread
  void on_frame(const Frame& frame);
  void tell_speed();

  // inputs
  void on_muscle_activation(const MuscleActivation& message);
  void on_joint_states(const sensor_msgs::JointState& message);
  void on_expression(const std_msgs::String& message);
  void on_bone_pose(const geometry_msgs::TransformStamped& message);
  void command(const char* topic, const std::vector<std::string>& names, const std::vector<double>& values);
  void refuse(const char* topic, const std::string& fault);
  void end_demo(const char* topic);

  // services
  bool on_reset(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool on_pause(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response);
  bool on_step(Step::Request& request, Step::Response& response);
  bool on_switch_effect(SwitchEffect::Request& request, SwitchEffect::Response& response);
  bool on_list_muscles(ListMuscles::Request& request, ListMuscles::Response& response);

  void on_tick();
  void play_demo(double time);
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);

  /// The runner, or nothing while there is no model; then `why` says why.
  std::shared_ptr<Runner> runner(std::string* why = nullptr) const;

  ros::NodeHandle handle_, private_handle_;
  const std::string name_;
  diagnostic_updater::Updater updater_;

  mutable std::mutex runner_mutex_;  ///< guards runner_, demo_, load_fault_, stage_, parameters_
  std::shared_ptr<Runner> runner_;
  std::shared_ptr<const DemoPlayer> demo_;
  std::string load_fault_;
  std::string stage_ = "starting";
  FaceParameters parameters_;

  std::mutex frame_mutex_;  ///< guards publisher_, frame_ and what belongs to them; never held while calling the runner
  FacePublisher publisher_;
  Frame frame_;  ///< the latest
  bool has_frame_ = false;
  bool frame_finite_ = true;
  std::uint64_t frames_dropped_ = 0;
  std::string speed_;        ///< what was told of it; empty: nothing yet
  ros::WallTime published_;  ///< latest frame of the runner
  ros::WallTime shown_;      ///< latest frame or repetition

  std::mutex target_mutex_;  ///< guards target_; held while the runner's controls are set, so that both agree
  std::map<std::string, double> target_;
  bool demo_playing_ = false;

  std::atomic<bool> paused_{ false };
  std::atomic<bool> stopping_{ false };
  std::vector<ros::Subscriber> subscribers_;
  std::vector<ros::ServiceServer> services_;
  ros::WallTimer tick_, diagnostics_;
  std::thread loader_;
};

}  // namespace frontalis
