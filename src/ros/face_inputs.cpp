#include "frontalis/ros/face_node.hpp"

#include "frontalis/error.hpp"
#include "frontalis/model/effects.hpp"
#include "frontalis/ros/conversions.hpp"

#include <cmath>

namespace frontalis
{

namespace
{

constexpr double warning_period = 2;  // [s] between two warnings about bad input

}  // namespace

void FaceNode::refuse(const char* topic, const std::string& fault)
{
  ROS_WARN_STREAM_THROTTLE(warning_period, name_ << ": message on ~" << topic << " refused: " << fault);
}

void FaceNode::end_demo(const char* topic)
{
  if (demo_playing_)
    ROS_INFO_STREAM(name_ << ": a message on ~" << topic << " takes over from the demo; ~reset starts it again");
  demo_playing_ = false;
}

void FaceNode::command(const char* topic, const std::vector<std::string>& names, const std::vector<double>& values)
{
  std::string why;
  const auto running = runner(&why);
  if (!running)
    return refuse(topic, why);
  std::map<std::string, double> activation;
  for (std::size_t entry = 0; entry < names.size(); ++entry)
    if (!activation.emplace(names[entry], values[entry]).second)
      return refuse(topic, "muscle '" + names[entry] + "' is named twice");
  try
  {
    const std::lock_guard<std::mutex> lock(target_mutex_);
    running->set_activation(activation);
    end_demo(topic);
    for (const auto& [name, value] : activation)
      target_[name] = value;
  }
  catch (const Error& error)
  {
    refuse(topic, error.what());
  }
}

void FaceNode::on_muscle_activation(const MuscleActivation& message)
{
  if (message.name.size() != message.activation.size())
    return refuse("muscle_activation", std::to_string(message.name.size()) + " names but " +
                                           std::to_string(message.activation.size()) +
                                           " activations; there must be one for each name");
  command("muscle_activation", message.name, message.activation);
}

void FaceNode::on_joint_states(const sensor_msgs::JointState& message)
{
  if (message.name.size() != message.position.size())
    return refuse("joint_states", std::to_string(message.name.size()) + " names but " +
                                      std::to_string(message.position.size()) +
                                      " positions; there must be one for each name");
  command("joint_states", message.name, message.position);
}

void FaceNode::on_expression(const std_msgs::String& message)
{
  std::string why;
  const auto running = runner(&why);
  if (!running)
    return refuse("expression", why);
  try
  {
    const std::lock_guard<std::mutex> lock(target_mutex_);
    running->set_expression(message.data);
    end_demo("expression");
    for (auto& [name, value] : target_)
      value = 0;
    for (const auto& expression : running->model().expressions)
      if (expression.name == message.data)
        for (const auto& [muscle, value] : expression.activation)
          target_[running->model().muscles.at(muscle).name] = value;
  }
  catch (const Error& error)
  {
    refuse("expression", error.what());
  }
}

void FaceNode::on_bone_pose(const geometry_msgs::TransformStamped& message)
{
  std::string why;
  const auto running = runner(&why);
  if (!running)
    return refuse("bone_pose", why);
  try
  {
    running->set_bone(message.child_frame_id, to_motion(message.transform));
  }
  catch (const Error& error)
  {
    refuse("bone_pose", error.what());
  }
}

bool FaceNode::on_reset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response)
{
  const auto running = runner(&response.message);
  if (!running)
    return true;
  try
  {
    const std::lock_guard<std::mutex> lock(target_mutex_);
    running->reset();
    for (auto& [name, value] : target_)
      value = 0;
    demo_playing_ = parameters_.demo && !demo_->empty();
    paused_ = running->paused();
    response.success = true;
  }
  catch (const Error& error)
  {
    response.message = error.what();
  }
  return true;
}

bool FaceNode::on_pause(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response)
{
  const auto running = runner(&response.message);
  if (!running)
    return true;
  try
  {
    running->pause(request.data);
    paused_ = running->paused();
    response.success = true;
  }
  catch (const Error& error)
  {
    response.message = error.what();
  }
  return true;
}

bool FaceNode::on_step(Step::Request& request, Step::Response& response)
{
  const auto running = runner(&response.message);
  if (!running)
    return true;
  if (!std::isfinite(request.seconds) || request.seconds <= 0)
  {
    response.message = "seconds: found " + std::to_string(request.seconds) + "; allowed is a finite time above 0";
    return true;
  }
  try
  {
    double time = 0;
    {
      const std::lock_guard<std::mutex> lock(frame_mutex_);
      time = frame_.time;
    }
    play_demo(time + request.seconds);
    const Frame frame = running->step(request.seconds);
    paused_ = running->paused();
    response.time = frame.time;
    response.success = !frame.failed;
    response.message = frame.failure;
  }
  catch (const Error& error)
  {
    response.message = error.what();
  }
  return true;
}

bool FaceNode::on_switch_effect(SwitchEffect::Request& request, SwitchEffect::Response& response)
{
  const auto running = runner(&response.message);
  if (!running)
    return true;
  try
  {
    if (!request.effect.empty())
      running->switch_effect(effect_from_name(request.effect), request.on);
    response.success = true;
  }
  catch (const Error& error)
  {
    response.message = error.what();
  }
  const EffectSet model = effects_of(running->model()), now = running->effects();
  for (const Effect effect : every_effect())
    if (model.has(effect))
    {
      response.name.push_back(name_of(effect));
      response.running.push_back(now.has(effect));
    }
  return true;
}

bool FaceNode::on_list_muscles(ListMuscles::Request&, ListMuscles::Response& response)
{
  const auto running = runner(&response.message);
  if (!running)
    return true;
  response.success = true;
  {
    const std::lock_guard<std::mutex> lock(frame_mutex_);
    response.activation.assign(frame_.activation.begin(), frame_.activation.end());
  }
  const std::lock_guard<std::mutex> lock(target_mutex_);
  const Model& model = running->model();
  response.activation.resize(model.muscles.size(), 0.0);
  for (const auto& muscle : model.muscles)
  {
    response.name.push_back(muscle.name);
    response.target.push_back(target_[muscle.name]);
  }
  for (const auto& expression : model.expressions)
    response.expressions.push_back(expression.name);
  response.expressions.push_back("relax");
  return true;
}

}  // namespace frontalis
