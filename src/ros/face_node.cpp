#include "frontalis/ros/face_node.hpp"

#include "frontalis/error.hpp"
#include "frontalis/model/model_file.hpp"
#include "frontalis/ros/model_source.hpp"
#include "frontalis/runner/profile_report.hpp"

#include <algorithm>
#include <exception>

namespace frontalis
{

namespace
{

constexpr double tick_period = 1.0 / 30;    // [s] of the demo's controls
constexpr double idle_period = 0.5;         // [s] after which a face that stands still is shown again
constexpr double diagnostics_period = 1.0;  // [s]
constexpr double stalled_after = 3.0;       // [s] without a frame
constexpr double speed_after = 3.0;         // [s] of running after which its speed is told
constexpr double slow = 0.95;               // of real time

}  // namespace

FaceNode::FaceNode(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle, const std::string& name)
    : handle_(handle),
      private_handle_(private_handle),
      name_(name),
      updater_(handle, private_handle, name),
      publisher_(private_handle),
      published_(ros::WallTime::now())
{
  updater_.setHardwareID("none");
  updater_.add("simulation", this, &FaceNode::diagnose);

  subscribers_.push_back(private_handle_.subscribe<MuscleActivation>(
      "muscle_activation", 10, [this](const MuscleActivation::ConstPtr& message) { on_muscle_activation(*message); }));
  subscribers_.push_back(private_handle_.subscribe<sensor_msgs::JointState>(
      "joint_states", 10, [this](const sensor_msgs::JointState::ConstPtr& message) { on_joint_states(*message); }));
  subscribers_.push_back(private_handle_.subscribe<std_msgs::String>(
      "expression", 10, [this](const std_msgs::String::ConstPtr& message) { on_expression(*message); }));
  subscribers_.push_back(private_handle_.subscribe<geometry_msgs::TransformStamped>(
      "bone_pose", 10, [this](const geometry_msgs::TransformStamped::ConstPtr& message) { on_bone_pose(*message); }));
  services_.push_back(private_handle_.advertiseService("reset", &FaceNode::on_reset, this));
  services_.push_back(private_handle_.advertiseService("pause", &FaceNode::on_pause, this));
  services_.push_back(private_handle_.advertiseService("step", &FaceNode::on_step, this));
  services_.push_back(private_handle_.advertiseService("switch_effect", &FaceNode::on_switch_effect, this));
  services_.push_back(private_handle_.advertiseService("list_muscles", &FaceNode::on_list_muscles, this));

  tick_ = private_handle_.createWallTimer(ros::WallDuration(tick_period),
                                          [this](const ros::WallTimerEvent&) { on_tick(); });
  diagnostics_ = private_handle_.createWallTimer(ros::WallDuration(diagnostics_period),
                                                 [this](const ros::WallTimerEvent&) { updater_.force_update(); });
  loader_ = std::thread([this] { load(); });
}

FaceNode::~FaceNode()
{
  // no callback may begin any more, then the loader and the runner end, while the publishers are still there
  stopping_ = true;
  tick_.stop();
  diagnostics_.stop();
  for (auto& subscriber : subscribers_)
    subscriber.shutdown();
  if (const auto running = runner())
    running->cancel_step();
  for (auto& service : services_)
    service.shutdown();
  loader_.join();
  std::shared_ptr<Runner> last;
  {
    const std::lock_guard<std::mutex> lock(runner_mutex_);
    last.swap(runner_);
  }
}

std::shared_ptr<const Model> FaceNode::make_model(const FaceParameters& parameters)
{
  const auto start = ros::WallTime::now();
  std::shared_ptr<const Model> model;
  if (!parameters.model.empty())
    model = std::make_shared<const Model>(read_model(parameters.model));
  else
  {
    BakeRequest request;
    request.program = find_program(parameters.program);
    request.scene = parameters.scene;
    request.mesh_directory = parameters.mesh_directory;
    request.accuracy = parameters.accuracy;
    request.cache = parameters.cache;
    ROS_INFO_STREAM(name_ << ": baking " << request.scene << " with " << request.program);
    const auto log = [this](const std::string& line)
    {
      ROS_INFO_STREAM(name_ << ": " << line);
      const std::lock_guard<std::mutex> lock(runner_mutex_);
      stage_ = "baking: " + line;
    };
    model = std::make_shared<const Model>(bake_in_process(request, log, stopping_));
  }
  ROS_INFO_STREAM(name_ << ": model ready after " << (ros::WallTime::now() - start).toSec()
                        << " s: " << model->voxels.size() << " voxels, " << model->nodes.size() << " nodes, "
                        << model->muscles.size() << " muscles, " << model->skin.vertices.size() << " skin vertices");
  return model;
}

void FaceNode::load()
{
  try
  {
    const FaceParameters parameters = read_parameters(private_handle_);
    const auto model = make_model(parameters);
    const auto demo = std::make_shared<const DemoPlayer>(*model);
    if (parameters.demo && demo->empty())
      ROS_WARN_STREAM(name_ << ": ~demo is true, but the scene has no demo");
    {
      const std::lock_guard<std::mutex> lock(runner_mutex_);
      parameters_ = parameters;
      demo_ = demo;
    }
    {
      const std::lock_guard<std::mutex> lock(target_mutex_);
      for (const auto& muscle : model->muscles)
        target_[muscle.name] = 0;
      demo_playing_ = parameters.demo && !demo->empty();
    }

    // the runner's first frame may come before its constructor returns: frames wait until the publisher has the model
    // (declared after the runner: on an exception frames flow again before the runner's thread is joined)
    std::shared_ptr<Runner> made;
    std::unique_lock<std::mutex> frames(frame_mutex_);
    RunnerSettings settings = parameters.runner;
    settings.wanted_field = [this, field = parameters.skin_field]
    { return publisher_.shows_field() ? std::make_optional(field) : std::nullopt; };
    made = std::make_shared<Runner>(model, settings, [this](const Frame& frame) { on_frame(frame); });
    const std::string frame_name = parameters.face_id.empty() ? model->face_frame : "face_" + parameters.face_id;
    publisher_.start(model, frame_name, parameters.parent_frame, made->description());
    published_ = shown_ = ros::WallTime::now();
    frames.unlock();

    paused_ = made->paused();
    // in lock-step nothing moves yet: show the face at rest
    if (parameters.runner.pace == Pace::lock_step)
      made->reset();
    if (const std::string measured = measured_profile(*model); !measured.empty())
      ROS_INFO_STREAM(name_ << ": " << measured);
    ROS_INFO_STREAM(name_ << ": running on " << made->description() << ", frame " << frame_name);
    const std::lock_guard<std::mutex> lock(runner_mutex_);
    runner_ = made;
  }
  catch (const std::exception& error)
  {
    if (!stopping_)
      ROS_ERROR_STREAM(name_ << ": no face to simulate: " << error.what());
    const std::lock_guard<std::mutex> lock(runner_mutex_);
    load_fault_ = error.what();
  }
}

std::shared_ptr<Runner> FaceNode::runner(std::string* why) const
{
  const std::lock_guard<std::mutex> lock(runner_mutex_);
  if (!runner_ && why)
    *why = load_fault_.empty() ? "the model is not ready yet (" + stage_ + ")" : load_fault_;
  return runner_;
}

void FaceNode::on_frame(const Frame& frame)
{
  const std::lock_guard<std::mutex> lock(frame_mutex_);
  frame_ = frame;
  has_frame_ = true;
  published_ = shown_ = ros::WallTime::now();
  tell_speed();
  frame_finite_ = publisher_.publish(frame_, ros::Time::now(), paused_);
  if (!frame_finite_)
  {
    ++frames_dropped_;
    ROS_ERROR_STREAM_THROTTLE(5, name_ << ": frame " << frame_.sequence << " is not finite and was not published");
  }
}

// once, when the real-time factor has settled
void FaceNode::tell_speed()
{
  if (!speed_.empty() || !publisher_.model() || parameters_.runner.pace == Pace::lock_step || frame_.failed ||
      frame_.wall_time < speed_after || !(frame_.real_time_factor > 0))
    return;
  speed_ = speed_report(*publisher_.model(), frame_.real_time_factor);
  if (frame_.real_time_factor < slow)
    ROS_WARN_STREAM(name_ << ": " << speed_);
  else
    ROS_INFO_STREAM(name_ << ": " << speed_);
}

void FaceNode::on_tick()
{
  const auto running = runner();
  std::string fault;
  {
    const std::lock_guard<std::mutex> lock(runner_mutex_);
    fault = load_fault_;
  }
  bool idle = false;
  double time = 0;
  {
    const std::lock_guard<std::mutex> lock(frame_mutex_);
    idle = (ros::WallTime::now() - shown_).toSec() > idle_period;
    time = frame_.time;
    if (idle)
      shown_ = ros::WallTime::now();
    // a face that stands still is shown again, for those who came late
    if (idle && running && has_frame_ && frame_finite_)
      publisher_.publish(frame_, ros::Time::now(), paused_);
    // one that is still being baked has not failed
    if (idle && !fault.empty())
      publisher_.publish_fault(fault, ros::Time::now());
  }
  // in lock-step the demo's target is set by the step alone
  if (running && !paused_ && parameters_.runner.pace != Pace::lock_step)
    play_demo(time);
}

void FaceNode::play_demo(double time)
{
  const std::lock_guard<std::mutex> lock(target_mutex_);
  if (!demo_playing_)
    return;
  const auto running = runner();
  if (!running)
    return;
  const auto activation = demo_->activation(time);
  running->set_activation(activation);
  target_ = activation;
}

void FaceNode::diagnose(diagnostic_updater::DiagnosticStatusWrapper& status)
{
  using diagnostic_msgs::DiagnosticStatus;
  std::string why;
  const auto running = runner(&why);
  if (!running)
  {
    const std::lock_guard<std::mutex> lock(runner_mutex_);
    status.summary(load_fault_.empty() ? DiagnosticStatus::WARN : DiagnosticStatus::ERROR, why);
    return;
  }

  const std::lock_guard<std::mutex> lock(frame_mutex_);
  const bool own_pace = parameters_.runner.pace != Pace::lock_step && !paused_;
  const double silence = (ros::WallTime::now() - published_).toSec();
  if (frame_.failed)
    status.summary(DiagnosticStatus::ERROR, frame_.failure);
  else if (!frame_finite_)
    status.summary(DiagnosticStatus::ERROR, "the latest frame is not finite and was not published; call ~reset");
  else if (own_pace && (!has_frame_ || silence > stalled_after))
    status.summary(DiagnosticStatus::WARN, "no frame for seconds");
  else if (!own_pace)
    status.summary(DiagnosticStatus::OK, parameters_.runner.pace == Pace::lock_step ? "waits for ~step" : "paused");
  else if (parameters_.runner.pace == Pace::real_time && frame_.time > 1 &&
           frame_.real_time_factor < parameters_.real_time_factor_warning)
    status.summaryf(DiagnosticStatus::WARN, "slow: real-time factor %.3g, below %.3g", frame_.real_time_factor,
                    parameters_.real_time_factor_warning);
  else
    status.summaryf(DiagnosticStatus::OK, "runs, real-time factor %.3g", frame_.real_time_factor);

  status.add("backend", running->description());
  status.add("accuracy", measured_profile(running->model()));
  status.add("speed", speed_);
  status.add("simulated time [s]", frame_.time);
  status.add("real-time factor", frame_.real_time_factor);
  status.add("time step [s]", frame_.time_step);
  status.add("steps", frame_.steps);
  status.add("kinetic energy [J]", frame_.monitor.kinetic);
  status.add("internal energy [J]", frame_.monitor.internal);
  status.add("hourglass energy [J]", frame_.monitor.hourglass);
  status.add("smallest volume ratio", frame_.monitor.worst_jacobian);
  status.add("voxels inside out", frame_.monitor.inverted);
  status.add("times gone back to a stable state", frame_.guard.rollbacks);
  if (frame_.guard.rollbacks > 0)
    status.add("why gone back the last time", words_for(frame_.guard.latest));
  status.add("frames not published because not finite", frames_dropped_);
}

}  // namespace frontalis
