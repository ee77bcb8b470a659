#pragma once

#include "frontalis/ros/face_inputs.hpp"
#include "frontalis/ros/face_publisher.hpp"
#include "frontalis/ros/fit_action.hpp"
#include "frontalis/ros/parameters.hpp"
#include "frontalis/ros/wall_throttle.hpp"
#include "frontalis/runner/runner.hpp"

#include <diagnostic_updater/diagnostic_updater.h>
#include <dynamic_reconfigure/server.h>
#include <frontalis/FaceConfig.h>
#include <frontalis/ListMuscles.h>
#include <frontalis/LoadScene.h>
#include <frontalis/Probe.h>
#include <frontalis/Step.h>
#include <frontalis/SwitchEffect.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include <atomic>
#include <memory>
#include <mutex>
#include <set>
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
  // run in the threads that load models
  void load();
  std::shared_ptr<const Model> make_model(const FaceParameters& parameters);
  /// Replaces the present model and its runner by new ones. If there is a fault, throws an Error and changes nothing.
  void replace_face(const FaceParameters& parameters);

  // run in the runner's thread
  void on_frame(const Frame& frame, std::uint64_t face);
  void on_progress(const Frame& frame, std::uint64_t face);
  void log_speed_once();
  /// Whether the face moves in ~step alone. The caller must hold frame_mutex_.
  bool stands() const { return paused_ || parameters_.runner.pace == Pace::lock_step; }

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
  bool on_load_scene(LoadScene::Request& request, LoadScene::Response& response);
  bool on_probe(Probe::Request& request, Probe::Response& response);
  /// The face that ~fit_activation is about. Throws an Error if there is none yet.
  FitAction::Face fitted_face() const;
  /// Asks the present runner whether it is paused, which may have taken the place of the one that was called.
  void note_pause();
  void on_config(FaceConfig& config, std::uint32_t level);
  /// Throws an Error if the configuration names something unknown, or an effect cannot be switched.
  void apply_config(Runner& running, const FaceConfig& config);

  // timers
  void repeat_frame_and_play();
  /// Publishes ~caption if its text has changed.
  void show_caption();
  void send_diagnostics();
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);

  /// The runner; null while there is no model, and then the reason is written to `reason`.
  std::shared_ptr<Runner> runner(std::string* reason = nullptr) const;

  ros::NodeHandle handle_, private_handle_;
  const std::string name_;
  const double diagnostic_period_;  ///< [s]; read before updater_, which reads the parameter too
  diagnostic_updater::Updater updater_;

  mutable std::mutex runner_mutex_;  ///< protects the members up to parameters_
  std::shared_ptr<Runner> runner_;
  std::string load_fault_;
  std::string loading_stage_ = "starting";
  FaceParameters parameters_;

  std::mutex frame_mutex_;  ///< protects the members up to last_published_; never held while the runner moves
  FacePublisher publisher_;
  const std::string loading_frame_;               ///< of the caption while there is no model
  std::atomic<std::uint64_t> present_face_{ 0 };  ///< whose frames are published; may be read without the mutex
  Frame frame_;                                   ///< the latest frame
  bool has_frame_ = false;
  bool frame_finite_ = true;
  std::uint64_t frames_dropped_ = 0;
  std::optional<std::string> caption_;  ///< text of ~caption; none before the first one of a face
  double slowness_ = 0;                 ///< how many times slower than real time the caption says; 0: nothing
  std::string speed_report_;            ///< as it was logged; empty if it was not logged yet
  WallThrottle frame_warning_, diagnostics_warning_;
  ros::WallTime last_frame_;      ///< when the runner made the latest frame
  ros::WallTime last_published_;  ///< when a frame was published the last time, new or repeated

  std::atomic<double> time_{ 0 };  ///< simulated time of the latest frame [s]
  std::atomic<bool> paused_{ false };
  std::atomic<bool> stopping_{ false };
  std::atomic<std::uint64_t> resets_{ 0 };  ///< number of calls of ~reset
  std::mutex loading_mutex_;                ///< held while a model is made, so that one is made at a time
  std::mutex stepping_mutex_;               ///< held during a call of ~step
  std::uint64_t faces_made_ = 0;
  FaceInputs inputs_;
  std::vector<ros::ServiceServer> services_;
  ros::CallbackQueue loading_queue_;  ///< queue of ~load_scene, which may take minutes
  ros::AsyncSpinner loading_spinner_;
  boost::recursive_mutex server_mutex_;  ///< mutex of server_; protects config_ and switched_off_
  std::optional<FaceConfig> config_;     ///< the latest that was applied
  std::set<std::string> switched_off_;   ///< effects that the configuration has switched off
  std::unique_ptr<dynamic_reconfigure::Server<FaceConfig>> server_;
  std::unique_ptr<FitAction> fit_;
  ros::WallTimer frame_timer_, diagnostics_timer_;
  std::thread loader_;
};

}  // namespace frontalis
