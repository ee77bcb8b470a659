#include "frontalis/ros/face_node.hpp"

#include "frontalis/error.hpp"
#include "frontalis/model/model_file.hpp"
#include "frontalis/ros/model_source.hpp"
#include "frontalis/runner/profile_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <filesystem>
#include <system_error>
#include <utility>

namespace frontalis
{

namespace
{

namespace fs = std::filesystem;

constexpr double play_period = 1.0 / 30;     // time between two updates of changing activations [s]
constexpr double repetition_period = 0.5;    // a face that stands still repeats its frame after this time [s]
constexpr double diagnostics_period = 1.0;   // time between two diagnostic messages without ~diagnostic_period [s]
constexpr double longest_period = 1e6;       // largest ~diagnostic_period [s]; ROS can count durations up to 2e9 s
constexpr double speed_settled_after = 3.0;  // the real-time factor is logged after this time [s]

// roslaunch starts nodes in ROS_HOME, so that a path that was meant relative to a shell's folder is not found.
void check_relative_path(const std::string& path)
{
  if (std::error_code unknown; fs::path(path).is_relative() && !fs::exists(path, unknown))
    throw Error(
        fmt::format("{}: no such file in {}, the folder in which this node runs; give an absolute path, such as "
                    "$PWD/{}",
                    path, fs::current_path(unknown).string(), path));
}

// Reads ~diagnostic_period. Replaces a bad value, because diagnostic_updater reads the parameter too and would end the
// node.
double read_diagnostic_period(const ros::NodeHandle& handle, const std::string& name)
{
  const double period = handle.param("diagnostic_period", diagnostics_period);
  if (period >= 0 && period <= longest_period)
    return std::max(period, 0.01);
  ROS_ERROR_STREAM(name << ": ~diagnostic_period is " << period << "; allowed are 0 to " << longest_period << " s; "
                        << diagnostics_period << " s is taken");
  handle.setParam("diagnostic_period", diagnostics_period);
  return diagnostics_period;
}

}  // namespace

FaceNode::FaceNode(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle, const std::string& name)
    : handle_(handle),
      private_handle_(private_handle),
      name_(name),
      diagnostic_period_(read_diagnostic_period(private_handle, name)),
      updater_(handle, private_handle, name),
      publisher_(private_handle),
      loading_frame_(private_handle.param<std::string>("parent_frame", "map")),
      last_frame_(ros::WallTime::now()),
      inputs_(
          private_handle, name, [this](std::string* reason) { return runner(reason); },
          [this] { return time_.load(); }),
      loading_spinner_(1, &loading_queue_)
{
  updater_.setHardwareID("none");
  updater_.add("simulation", this, &FaceNode::diagnose);

  const auto serve = [this](ros::NodeHandle& node, const char* service, auto handler)
  { services_.push_back(node.advertiseService(service, handler, this)); };
  serve(private_handle_, "reset", &FaceNode::on_reset);
  serve(private_handle_, "pause", &FaceNode::on_pause);
  serve(private_handle_, "step", &FaceNode::on_step);
  serve(private_handle_, "switch_effect", &FaceNode::on_switch_effect);
  serve(private_handle_, "list_muscles", &FaceNode::on_list_muscles);
  serve(private_handle_, "probe", &FaceNode::on_probe);
  ros::NodeHandle loading_handle = private_handle_;
  loading_handle.setCallbackQueue(&loading_queue_);
  serve(loading_handle, "load_scene", &FaceNode::on_load_scene);
  loading_spinner_.start();
  fit_ = std::make_unique<FitAction>(
      private_handle_, [this] { return fitted_face(); },
      [this](const auto& muscles, const auto& activations)
      { return inputs_.set("fit_activation", ros::Time(), muscles, activations); });

  frame_timer_ = private_handle_.createWallTimer(ros::WallDuration(play_period),
                                                 [this](const ros::WallTimerEvent&) { repeat_frame_and_play(); });
  diagnostics_timer_ = private_handle_.createWallTimer(ros::WallDuration(diagnostic_period_),
                                                       [this](const ros::WallTimerEvent&) { send_diagnostics(); });
  loader_ = std::thread([this] { load(); });
}

FaceNode::~FaceNode()
{
  // The order matters: first no further callback may begin; then loaders and runner, which use the publishers, end.
  stopping_ = true;
  frame_timer_.stop();
  diagnostics_timer_.stop();
  fit_.reset();
  inputs_.shutdown();
  if (const auto running = runner())
    running->cancel_step();
  for (auto& service : services_)
    service.shutdown();
  loading_spinner_.stop();
  loader_.join();
  server_.reset();
  const std::shared_ptr<Runner> last = runner();  // keeps the runner until after the mutex is unlocked
  const std::lock_guard<std::mutex> lock(runner_mutex_);
  runner_.reset();
}

std::shared_ptr<const Model> FaceNode::make_model(const FaceParameters& parameters)
{
  const auto start = ros::WallTime::now();
  std::shared_ptr<const Model> model;
  check_relative_path(parameters.model.empty() ? parameters.bake.scene : parameters.model);
  if (!parameters.model.empty())
    model = std::make_shared<const Model>(read_model(parameters.model));
  else
  {
    BakeRequest request = parameters.bake;
    request.program = find_program(request.program);
    ROS_INFO_STREAM(name_ << ": baking " << request.scene << " with " << request.program);
    const auto log = [this](const std::string& line)
    {
      if (line.rfind("warning", 0) == 0)
        ROS_WARN_STREAM(name_ << ": " << line);
      else
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

void FaceNode::replace_face(const FaceParameters& parameters)
{
  const auto model = make_model(parameters);
  if (parameters.inputs.demo && model->demo.empty())
    ROS_WARN_STREAM(name_ << ": ~demo is true, but the scene has no demo");

  // frames of the new runner are ignored until it has replaced the present one
  const std::uint64_t face = ++faces_made_;
  RunnerSettings settings = parameters.runner;
  if (ros::Time::isSimTime())
    settings.clock = [] { return ros::Time::now().toSec(); };
  settings.wanted_field = [this] { return publisher_.wanted_field(); };
  settings.wants_displacements = [this] { return publisher_.shows_muscles(); };
  // ROS waits for the callback of a long ~step before it lets this object be destroyed.
  // A ~step that begins while another face takes the place of this one must not go on either.
  settings.ends_steps = [this, face] { return stopping_ || ros::isShuttingDown() || present_face_ > face; };
  settings.wants_bone_forces = [this] { return publisher_.shows_bone_forces(); };
  settings.on_progress = [this, face](const Frame& frame) { on_progress(frame, face); };
  const auto made =
      std::make_shared<Runner>(model, settings, [this, face](const Frame& frame) { on_frame(frame, face); });
  const std::string frame_name = parameters.face_id.empty() ? model->face_frame : "face_" + parameters.face_id;
  inputs_.start(model, parameters.inputs, frame_name);
  std::shared_ptr<Runner> before;
  {
    const std::scoped_lock lock(runner_mutex_, frame_mutex_);
    publisher_.start(model, frame_name, parameters.parent_frame, made->description(), parameters.wrinkles_in);
    publisher_.set_colour(parameters.skin_colour, parameters.skin_field, parameters.colour_range);
    present_face_ = face;
    frame_ = Frame();
    has_frame_ = false;
    frame_finite_ = true;
    speed_report_.clear();
    caption_.reset();
    last_frame_ = last_published_ = ros::WallTime::now();
    time_ = 0;
    parameters_ = parameters;
    load_fault_.clear();
    before = std::exchange(runner_, made);
  }
  // A reset publishes the face at rest, also in lock-step. It comes first, because it forgets commands.
  inputs_.reset(*made);
  if (before)
    before->cancel_step();
  before.reset();
  paused_ = made->paused();
  {
    // the new runner has all effects switched on
    const boost::recursive_mutex::scoped_lock lock(server_mutex_);
    switched_off_.clear();
    if (server_ && config_)
      on_config(*config_, 0);
    else
    {
      server_ = std::make_unique<dynamic_reconfigure::Server<FaceConfig>>(server_mutex_, private_handle_);
      server_->setCallback([this](FaceConfig& config, std::uint32_t level) { on_config(config, level); });
    }
  }
  if (const std::string measured = measured_profile(*model); !measured.empty())
    ROS_INFO_STREAM(name_ << ": " << measured);
  ROS_INFO_STREAM(name_ << ": running on " << made->description() << ", frame " << frame_name);
}

void FaceNode::load()
{
  const std::lock_guard<std::mutex> one_at_a_time(loading_mutex_);
  if (runner())
    return;  // ~load_scene was faster
  try
  {
    replace_face(read_parameters(private_handle_));
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

void FaceNode::on_frame(const Frame& frame, std::uint64_t face)
{
  const std::lock_guard<std::mutex> lock(frame_mutex_);
  if (face != present_face_)
    return;
  if (frame.failed && !frame_.failed)
    ROS_ERROR_STREAM(name_ << ": " << frame.failure << "; ~reset starts the face again");
  frame_ = frame;
  time_ = frame.time;
  has_frame_ = true;
  last_frame_ = last_published_ = ros::WallTime::now();
  log_speed_once();
  frame_finite_ = publisher_.publish(frame_, ros::Time::now(), stands());
  if (!frame_finite_)
  {
    ++frames_dropped_;
    if (frame_warning_.passes(5))
      ROS_ERROR_STREAM(name_ << ": frame " << frame_.sequence << " is not finite and was not published");
  }
}

void FaceNode::on_progress(const Frame& frame, std::uint64_t face)
{
  const std::lock_guard<std::mutex> lock(frame_mutex_);
  if (face != present_face_)
    return;
  // Commands are played at this time, also if frames are rare.
  time_ = frame.time;
  // The frame before is not sent again now, because its state is older.
  last_published_ = ros::WallTime::now();
  publisher_.publish_state(frame, ros::Time::now(), stands());
}

// logs the real-time factor once it has settled
void FaceNode::log_speed_once()
{
  if (!speed_report_.empty() || !publisher_.model() || parameters_.runner.pace == Pace::lock_step || frame_.failed ||
      frame_.wall_time < speed_settled_after || !(frame_.real_time_factor > 0))
    return;
  speed_report_ = speed_report(*publisher_.model(), frame_.real_time_factor);
  if (frame_.real_time_factor < sufficient_real_time_factor)
    ROS_WARN_STREAM(name_ << ": the face moves in slow motion, 1 : "
                          << fmt::format("{:.2g}", 1 / frame_.real_time_factor) << " (" << speed_report_ << ")");
  else
    ROS_INFO_STREAM(name_ << ": " << speed_report_);
}

// The caption names the expression, and says so if the face moves in slow motion. Before there is a face, it says what
// is being done to make it.
void FaceNode::show_caption()
{
  std::string text = inputs_.shown_expression(time_);
  std::replace(text.begin(), text.end(), '_', ' ');
  const std::scoped_lock lock(runner_mutex_, frame_mutex_);
  if (!runner_)
    text = load_fault_.empty() ? "The face is being made\n" + loading_stage_ : "There is no face; the log says why";
  const double factor = frame_.real_time_factor;
  if (!runner_ || parameters_.runner.pace != Pace::real_time || paused_ || !(factor > 0) ||
      factor >= sufficient_real_time_factor)
    slowness_ = 0;
  else if (std::abs(1 / factor - slowness_) > 0.2 * slowness_)
    slowness_ = 1 / factor;  // small changes are left out, because a figure that always changes cannot be read
  if (slowness_ > 0)
    text += fmt::format("{}slow motion, 1 : {:.2g}", text.empty() ? "" : "\n", slowness_);
  if (text == caption_ || (!runner_ && loading_frame_.empty()))
    return;
  caption_ = text;
  publisher_.publish_caption(text, loading_frame_);
}

void FaceNode::repeat_frame_and_play()
{
  std::shared_ptr<Runner> running;
  bool steps_by_itself = false;
  {
    const std::scoped_lock lock(runner_mutex_, frame_mutex_);
    running = runner_;
    // In lock-step, not this timer but ~step sets the activations of the demo and of the commands.
    steps_by_itself = parameters_.runner.pace != Pace::lock_step;
    // In a lock-step replay in simulated time, each frame must be published only once.
    const bool once = ros::Time::isSimTime() && !steps_by_itself;
    const double rarely = running ? 2 / running->frame_rate() : 0;
    if (!once && (ros::WallTime::now() - last_published_).toSec() > std::max(repetition_period, rarely))
    {
      last_published_ = ros::WallTime::now();
      // A face that stands still publishes its frame again, for late subscribers.
      if (runner_ && has_frame_ && frame_finite_)
        publisher_.publish(frame_, ros::Time::now(), stands());
      // This reports a model that could not be made, not one that is still being made.
      if (!load_fault_.empty())
        publisher_.publish_fault(load_fault_, ros::Time::now());
    }
  }
  if (running && !paused_ && steps_by_itself)
    inputs_.play(*running);
  show_caption();
}

}  // namespace frontalis
