#include "frontalis/ros/face_inputs.hpp"

#include "frontalis/error.hpp"
#include "frontalis/suggestion.hpp"

#include <fmt/format.h>
#include <ros/console.h>

#include <algorithm>

namespace frontalis
{

FaceInputs::FaceInputs(ros::NodeHandle private_handle, const std::string& name, FindRunner runner,
                       std::function<double()> now)
    : name_(name), runner_(std::move(runner)), now_(std::move(now))
{
  const auto subscribe = [&](const char* topic, auto handler)
  { subscribers_.push_back(private_handle.subscribe(topic, 10, handler, this)); };
  subscribe("muscle_activation", &FaceInputs::on_muscle_activation);
  subscribe("joint_states", &FaceInputs::on_joint_states);
  subscribe("joint_trajectory", &FaceInputs::on_joint_trajectory);
  subscribe("action_units", &FaceInputs::on_action_units);
  subscribe("blendshapes", &FaceInputs::on_blendshapes);
  subscribe("expression", &FaceInputs::on_expression);
  subscribe("bone_pose", &FaceInputs::on_bone_pose);
}

void FaceInputs::shutdown()
{
  for (auto& subscriber : subscribers_)
    subscriber.shutdown();
}

void FaceInputs::start(const std::shared_ptr<const Model>& model, const InputParameters& parameters,
                       const std::string& face_frame)
{
  auto table = std::make_unique<BlendshapeTable>(parameters.blendshapes, *model);
  for (const BoneFrame& followed : parameters.bone_frames)
    if (std::find(model->bones.begin(), model->bones.end(), followed.bone) == model->bones.end())
      throw Error(fmt::format("~bone_frames: no bone is called '{}'; the bones are {}", followed.bone,
                              list_with_suggestion(followed.bone, model->bones)));
  auto follower = std::make_unique<BoneFollower>(parameters.bone_frames, face_frame, parameters.bone_speed);
  auto demo = std::make_unique<DemoPlayer>(model);
  const std::lock_guard<std::mutex> lock(mutex_);
  model_ = model;
  face_frame_ = face_frame;
  parameters_ = parameters;
  demo_ = std::move(demo);
  demo_playing_ = parameters.demo && !demo_->empty();
  commands_ = std::make_unique<MuscleCommands>(model);
  bones_ = {};
  posed_.clear();
  silent_ = false;
  blendshapes_ = std::move(table);
  lacking_.clear();
  follower_ = std::move(follower);
  followed_ = 0;
}

void FaceInputs::configure(const InputParameters& parameters)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  parameters_ = parameters;
  silent_ = silent_ && parameters.command_timeout > 0;
}

void FaceInputs::reset(Runner& running)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  running.reset();
  commands_->clear();
  bones_ = {};
  posed_.clear();
  silent_ = false;
  demo_playing_ = parameters_.demo && !demo_->empty();
  follower_->clear();
  followed_ = 0;
}

void FaceInputs::play(Runner& running, double time)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  play_at(running, time);
}

void FaceInputs::play(Runner& running)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  play_at(running, now_());
}

// The caller must hold the mutex.
void FaceInputs::play_at(Runner& running, double time)
{
  if (&running.model() != model_.get())
    return;  // the runner of another scene is about to replace this one
  if (demo_playing_)
  {
    running.set_activation(demo_->activation(time));
    for (const auto& [bone, motion] : demo_->bones(time))
      running.set_bone(bone, motion);
  }
  else
  {
    const double late = commands_->silence(time) - parameters_.command_timeout;
    if (parameters_.command_timeout > 0 && late > 0 && !silent_)
    {
      silent_ = true;
      commands_->relax(time - late, parameters_.relax_time);
      if (!posed_.empty())
        bones_ = { { time - late, time - late + parameters_.relax_time },
                   { present_bones(running, time - late), rest_controls(*model_) } };
      ROS_WARN_STREAM(name_ << ": no command for " << parameters_.command_timeout << " s: the face relaxes over "
                            << parameters_.relax_time << " s");
    }
    running.set_activation(commands_->at(time));
    set_bones(running, time);
  }
  if (time > followed_)
  {
    for (const auto& [bone, motion] : follower_->follow(time - followed_, parameters_.stamp_tolerance))
      running.set_bone(bone, motion);
    followed_ = time;
  }
}

std::string FaceInputs::shown_expression(double time) const
{
  const std::lock_guard<std::mutex> lock(mutex_);
  return demo_playing_ ? demo_->expression(time) : "";
}

bool FaceInputs::timed(double time) const
{
  const std::lock_guard<std::mutex> lock(mutex_);
  return commands_ && (commands_->moving(time) || (parameters_.command_timeout > 0 && !silent_));
}

std::map<std::string, double> FaceInputs::target(double time) const
{
  const std::lock_guard<std::mutex> lock(mutex_);
  return commands_ ? present(time) : std::map<std::string, double>();
}

std::map<std::string, double> FaceInputs::present(double time) const
{
  return demo_playing_ ? demo_->activation(time) : commands_->at(time);
}

Controls FaceInputs::present_bones(const Runner& running, double time) const
{
  Controls now = rest_controls(*model_);
  now.bone = running.bones();
  for (std::size_t bone = 0; bone < now.bone.size(); ++bone)
    if (posed_.count(model_->bones[bone]) > 0)
      now.bone[bone] = bones_.at(time).bone[bone];
  if (demo_playing_)
    for (const auto& [bone, motion] : demo_->bones(time))
      set_bone_motion(*model_, bone, motion, now.bone);
  return now;
}

void FaceInputs::set_bones(Runner& running, double time) const
{
  if (posed_.empty())
    return;
  const Controls now = bones_.at(time);
  for (std::size_t bone = 0; bone < now.bone.size(); ++bone)
    if (posed_.count(model_->bones[bone]) > 0)
      running.set_bone(model_->bones[bone], motion_in_face(*model_, now.bone[bone]));
}

std::uint64_t FaceInputs::messages() const
{
  const std::lock_guard<std::mutex> lock(mutex_);
  std::uint64_t count = 0;
  for (const auto& [topic, series] : topics_)
    count += series.taken + series.refused;
  return count;
}

void FaceInputs::diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) const
{
  using diagnostic_msgs::DiagnosticStatus;
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!commands_)
    return;
  if (silent_)
    status.mergeSummaryf(DiagnosticStatus::WARN, "no command for more than %g s: the face relaxes",
                         parameters_.command_timeout);
  for (const auto& [topic, series] : topics_)
  {
    status.add("messages taken on ~" + topic, series.taken);
    if (series.refused == 0)
      continue;
    status.add("messages refused on ~" + topic, series.refused);
    status.add("latest refusal on ~" + topic, series.reason);
  }
  for (const auto& [bone, followed] : follower_->status())
  {
    if (!followed.fault.empty())
      status.mergeSummary(DiagnosticStatus::WARN, "bone '" + bone + "': " + followed.fault);
    status.add("jumps of the frame of bone '" + bone + "'", followed.jumps);
  }
}

}  // namespace frontalis
