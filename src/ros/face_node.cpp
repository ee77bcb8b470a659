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

constexpr double demo_period = 1.0 / 30;     // time between two settings of the demo's activations [s]
constexpr double repetition_period = 0.5;    // a face that stands still repeats its frame after this time [s]
constexpr double diagnostics_period = 1.0;   // time between two messages [s]
constexpr double stalled_after = 3.0;        // diagnostics warn if there is no frame for this time [s]
constexpr double speed_settled_after = 3.0;  // the real-time factor is logged after this time [s]

}  // namespace

FaceNode::FaceNode(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle, const std::string& name)
    : handle_(handle),
      private_handle_(private_handle),
      name_(name),
      updater_(handle, private_handle, name),
      publisher_(private_handle),
      last_frame_(ros::WallTime::now())
{
  updater_.setHardwareID("none");
  updater_.add("simulation", this, &FaceNode::diagnose);

  const auto subscribe = [this](const char* topic, auto handler)
  { subscribers_.push_back(private_handle_.subscribe(topic, 10, handler, this)); };
  subscribe("muscle_activation", &FaceNode::on_muscle_activation);
  subscribe("joint_states", &FaceNode::on_joint_states);
  subscribe("expression", &FaceNode::on_expression);
  subscribe("bone_pose", &FaceNode::on_bone_pose);
  const auto serve = [this](const char* service, auto handler)
  { services_.push_back(private_handle_.advertiseService(service, handler, this)); };
  serve("reset", &FaceNode::on_reset);
  serve("pause", &FaceNode::on_pause);
  serve("step", &FaceNode::on_step);
  serve("switch_effect", &FaceNode::on_switch_effect);
  serve("list_muscles", &FaceNode::on_list_muscles);

  frame_timer_ = private_handle_.createWallTimer(ros::WallDuration(demo_period),
                                                 [this](const ros::WallTimerEvent&) { repeat_frame_and_play_demo(); });
  diagnostics_timer_ = private_handle_.createWallTimer(ros::WallDuration(diagnostics_period),
                                                       [this](const ros::WallTimerEvent&) { updater_.force_update(); });
  loader_ = std::thread([this] { load(); });
}

FaceNode::~FaceNode()
{
  // Order matters: no callback may begin any more; then the loader and the runner end, which still use the publishers.
  stopping_ = true;
  frame_timer_.stop();
  diagnostics_timer_.stop();
  for (auto& subscriber : subscribers_)
    subscriber.shutdown();
  if (const auto running = runner())
    running->cancel_step();
  for (auto& service : services_)
    service.shutdown();
  loader_.join();
  const std::shared_ptr<Runner> last = runner();  // keeps the runner until after the mutex is unlocked
  const std::lock_guard<std::mutex> lock(runner_mutex_);
  runner_.reset();
}

std::shared_ptr<const Model> FaceNode::make_model(const FaceParameters& parameters)
{
  const auto start = ros::WallTime::now();
  std::shared_ptr<const Model> model;
  if (!parameters.model.empty())
    model = std::make_shared<const Model>(read_model(parameters.model));
  else
  {
    BakeRequest request = parameters.bake;
    request.program = find_program(request.program);
    ROS_INFO_STREAM(name_ << ": baking " << request.scene << " with " << request.program);
    const auto log = [this](const std::string& line)
    {
      ROS_INFO_STREAM(name_ << ": " << line);
      const std::lock_guard<std::mutex> lock(runner_mutex_);
      loading_stage_ = "baking: " + line;
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
    const auto demo = std::make_shared<const DemoPlayer>(model);
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

    // The runner's first frame may come before its constructor returns: the lock makes frames wait until the publisher
    // has the model. It is declared after the runner, so that after an exception the runner's thread, which may wait
    // for it, can end.
    std::shared_ptr<Runner> made;
    std::unique_lock<std::mutex> frames(frame_mutex_);
    RunnerSettings settings = parameters.runner;
    settings.wanted_field = [this, field = parameters.skin_field]
    { return publisher_.shows_field() ? std::make_optional(field) : std::nullopt; };
    made = std::make_shared<Runner>(model, settings, [this](const Frame& frame) { on_frame(frame); });
    const std::string frame_name = parameters.face_id.empty() ? model->face_frame : "face_" + parameters.face_id;
    publisher_.start(model, frame_name, parameters.parent_frame, made->description());
    last_frame_ = last_published_ = ros::WallTime::now();
    frames.unlock();

    paused_ = made->paused();
    // in lock-step no frame comes before the first ~step: publish the face at rest
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
      ROS_ERROR_STREAM(name_ << ": there is no face to simulate: " << error.what());
    const std::lock_guard<std::mutex> lock(runner_mutex_);
    load_fault_ = error.what();
  }
}

std::shared_ptr<Runner> FaceNode::runner(std::string* reason) const
{
  const std::lock_guard<std::mutex> lock(runner_mutex_);
  if (!runner_ && reason)
    *reason = load_fault_.empty() ? "the model is not ready yet (" + loading_stage_ + ")" : load_fault_;
  return runner_;
}

void FaceNode::on_frame(const Frame& frame)
{
  const std::lock_guard<std::mutex> lock(frame_mutex_);
  frame_ = frame;
  has_frame_ = true;
  last_frame_ = last_published_ = ros::WallTime::now();
  log_speed_once();
  frame_finite_ = publisher_.publish(frame_, ros::Time::now(), paused_);
  if (!frame_finite_)
  {
    ++frames_dropped_;
    ROS_ERROR_STREAM_THROTTLE(5, name_ << ": frame " << frame_.sequence << " is not finite and was not published");
  }
}

// logs the real-time factor once it has settled
void FaceNode::log_speed_once()
{
  if (!speed_report_.empty() || !publisher_.model() || parameters_.runner.pace == Pace::lock_step || frame_.failed ||
      frame_.wall_time < speed_settled_after || !(frame_.real_time_factor > 0))
    return;
  speed_report_ = speed_report(*publisher_.model(), frame_.real_time_factor);
  if (frame_.real_time_factor < sufficient_real_time_factor)
    ROS_WARN_STREAM(name_ << ": " << speed_report_);
  else
    ROS_INFO_STREAM(name_ << ": " << speed_report_);
}

void FaceNode::repeat_frame_and_play_demo()
{
  double time = 0;
  {
    const std::scoped_lock lock(runner_mutex_, frame_mutex_);
    time = frame_.time;
    if ((ros::WallTime::now() - last_published_).toSec() > repetition_period)
    {
      last_published_ = ros::WallTime::now();
      // resend the frame of a face that stands still, for late subscribers
      if (runner_ && has_frame_ && frame_finite_)
        publisher_.publish(frame_, ros::Time::now(), paused_);
      // a face whose model could not be made has failed; one that is still being baked has not
      if (!load_fault_.empty())
        publisher_.publish_fault(load_fault_, ros::Time::now());
    }
  }
  // in lock-step ~step sets the demo's activations
  if (!paused_ && parameters_.runner.pace != Pace::lock_step)
    play_demo(time);
}

void FaceNode::play_demo(double time)
{
  const std::lock_guard<std::mutex> lock(target_mutex_);
  const auto running = runner();
  if (!demo_playing_ || !running)
    return;
  const auto activation = demo_->activation(time);
  running->set_activation(activation);
  for (const auto& [bone, motion] : demo_->bones(time))
    running->set_bone(bone, motion);
  target_ = activation;
}

void FaceNode::diagnose(diagnostic_updater::DiagnosticStatusWrapper& status)
{
  using diagnostic_msgs::DiagnosticStatus;
  std::string reason;
  const auto running = runner(&reason);
  if (!running)
  {
    const std::lock_guard<std::mutex> lock(runner_mutex_);
    status.summary(load_fault_.empty() ? DiagnosticStatus::WARN : DiagnosticStatus::ERROR, reason);
    return;
  }

  const std::lock_guard<std::mutex> lock(frame_mutex_);
  const bool moves_by_itself = parameters_.runner.pace != Pace::lock_step && !paused_;
  const double silence = (ros::WallTime::now() - last_frame_).toSec();
  if (frame_.failed)
    status.summary(DiagnosticStatus::ERROR, frame_.failure);
  else if (!frame_finite_)
    status.summary(DiagnosticStatus::ERROR, "the latest frame is not finite and was not published; call ~reset");
  else if (moves_by_itself && (!has_frame_ || silence > stalled_after))
    status.summaryf(DiagnosticStatus::WARN, "no frame for more than %g seconds", stalled_after);
  else if (!moves_by_itself)
    status.summary(DiagnosticStatus::OK, parameters_.runner.pace == Pace::lock_step ? "waiting for ~step" : "paused");
  else if (parameters_.runner.pace == Pace::real_time && frame_.time > 1 &&
           frame_.real_time_factor < parameters_.real_time_factor_warning)
    status.summaryf(DiagnosticStatus::WARN, "too slow: the real-time factor is %.3g, below %.3g",
                    frame_.real_time_factor, parameters_.real_time_factor_warning);
  else
    status.summaryf(DiagnosticStatus::OK, "running with a real-time factor of %.3g", frame_.real_time_factor);

  status.add("backend", running->description());
  status.add("accuracy", measured_profile(running->model()));
  status.add("speed", speed_report_);
  status.add("simulated time [s]", frame_.time);
  status.add("real-time factor", frame_.real_time_factor);
  status.add("time step [s]", frame_.time_step);
  status.add("steps", frame_.steps);
  status.add("kinetic energy [J]", frame_.monitor.kinetic);
  status.add("internal energy [J]", frame_.monitor.internal);
  status.add("hourglass energy [J]", frame_.monitor.hourglass);
  status.add("smallest volume ratio", frame_.monitor.worst_jacobian);
  status.add("inverted voxels", frame_.monitor.inverted);
  status.add("nodes past the rim of their surface", frame_.monitor.past_rim);
  status.add("returns to an earlier stable state", frame_.guard.rollbacks);
  if (frame_.guard.rollbacks > 0)
    status.add("reason of the latest return", words_for(frame_.guard.latest));
  status.add("frames not published as not finite", frames_dropped_);
}

}  // namespace frontalis
