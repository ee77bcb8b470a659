#include "frontalis/ros/face_node.hpp"

#include "frontalis/error.hpp"
#include "frontalis/model/effects.hpp"
#include "frontalis/ros/conversions.hpp"
#include "frontalis/runner/named_controls.hpp"

#include <fmt/format.h>

#include <cmath>

namespace frontalis
{

namespace
{

constexpr double warning_period = 2;  // between two warnings about refused messages [s]

}  // namespace

void FaceNode::refuse(const char* topic, const std::string& reason)
{
  ROS_WARN_STREAM_THROTTLE(warning_period, name_ << ": message on ~" << topic << " refused: " << reason);
}

template <typename Response, typename Act>
bool FaceNode::answer(Response& response, const Act& act)
{
  const auto running = runner(&response.message);
  if (!running)
    return true;
  try
  {
    response.success = true;
    act(*running);
  }
  catch (const Error& error)
  {
    response.success = false;
    response.message = error.what();
  }
  return true;
}

template <typename Act>
void FaceNode::take_message(const char* topic, const Act& act)
{
  std_srvs::Trigger::Response outcome;
  answer(outcome, act);
  if (!outcome.success)
    refuse(topic, outcome.message);
}

void FaceNode::end_demo(const char* topic)
{
  if (demo_playing_)
    ROS_INFO_STREAM(name_ << ": a message on ~" << topic << " ends the demo; ~reset starts it again");
  demo_playing_ = false;
}

void FaceNode::set_activation(const char* topic, const std::vector<std::string>& names,
                              const std::vector<double>& values)
{
  take_message(topic,
               [&](Runner& running)
               {
                 if (names.size() != values.size())
                   throw Error(fmt::format("{} names but {} activations; there must be one per name", names.size(),
                                           values.size()));
                 std::map<std::string, double> activation;
                 for (std::size_t entry = 0; entry < names.size(); ++entry)
                   if (!activation.emplace(names[entry], values[entry]).second)
                     throw Error("muscle '" + names[entry] + "' is named twice");
                 const std::lock_guard<std::mutex> lock(target_mutex_);
                 running.set_activation(activation);
                 end_demo(topic);
                 for (const auto& [name, value] : activation)
                   target_[name] = value;
               });
}

void FaceNode::on_muscle_activation(const MuscleActivation& message)
{
  set_activation("muscle_activation", message.name, message.activation);
}

void FaceNode::on_joint_states(const sensor_msgs::JointState& message)
{
  set_activation("joint_states", message.name, message.position);
}

void FaceNode::on_expression(const std_msgs::String& message)
{
  take_message("expression",
               [&](Runner& running)
               {
                 const std::lock_guard<std::mutex> lock(target_mutex_);
                 running.set_expression(message.data);
                 end_demo("expression");
                 const auto activation = expression_controls(running.model(), message.data).activation;
                 for (std::size_t muscle = 0; muscle < activation.size(); ++muscle)
                   target_[running.model().muscles[muscle].name] = activation[muscle];
               });
}

void FaceNode::on_bone_pose(const geometry_msgs::TransformStamped& message)
{
  take_message("bone_pose",
               [&](Runner& running)
               {
                 const std::lock_guard<std::mutex> lock(target_mutex_);
                 running.set_bone(message.child_frame_id, to_motion(message.transform));
                 if (demo_->moves(message.child_frame_id))
                   end_demo("bone_pose");
               });
}

bool FaceNode::on_reset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response)
{
  return answer(response,
                [&](Runner& running)
                {
                  const std::lock_guard<std::mutex> lock(target_mutex_);
                  running.reset();
                  for (auto& [name, value] : target_)
                    value = 0;
                  demo_playing_ = parameters_.demo && !demo_->empty();
                  paused_ = running.paused();
                });
}

bool FaceNode::on_pause(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response)
{
  return answer(response,
                [&](Runner& running)
                {
                  running.pause(request.data);
                  paused_ = running.paused();
                });
}

bool FaceNode::on_step(Step::Request& request, Step::Response& response)
{
  return answer(
      response,
      [&](Runner& running)
      {
        if (!std::isfinite(request.seconds) || request.seconds <= 0)
          throw Error(fmt::format("seconds: found {}; allowed are finite durations above 0", request.seconds));
        double time = 0;
        {
          const std::lock_guard<std::mutex> lock(frame_mutex_);
          time = frame_.time;
        }
        play_demo(time + request.seconds);
        const Frame frame = running.step(request.seconds);
        paused_ = running.paused();
        response.time = frame.time;
        response.success = !frame.failed;
        response.message = frame.failure;
      });
}

bool FaceNode::on_switch_effect(SwitchEffect::Request& request, SwitchEffect::Response& response)
{
  answer(response,
         [&](Runner& running)
         {
           if (!request.effect.empty())
             running.switch_effect(effect_from_name(request.effect), request.on);
         });
  if (const auto running = runner())
  {
    const EffectSet of_model = effects_of(running->model()), switched_on = running->effects();
    for (const Effect effect : every_effect())
      if (of_model.has(effect))
      {
        response.name.push_back(name_of(effect));
        response.running.push_back(switched_on.has(effect));
      }
  }
  return true;
}

bool FaceNode::on_list_muscles(ListMuscles::Request&, ListMuscles::Response& response)
{
  return answer(response,
                [&](const Runner& running)
                {
                  {
                    const std::lock_guard<std::mutex> lock(frame_mutex_);
                    response.activation.assign(frame_.activation.begin(), frame_.activation.end());
                  }
                  const std::lock_guard<std::mutex> lock(target_mutex_);
                  const Model& model = running.model();
                  response.activation.resize(model.muscles.size(), 0.0);
                  for (const auto& muscle : model.muscles)
                  {
                    response.name.push_back(muscle.name);
                    response.target.push_back(target_[muscle.name]);
                  }
                  for (const auto& expression : model.expressions)
                    response.expressions.push_back(expression.name);
                  response.expressions.push_back("relax");
                });
}

}  // namespace frontalis
