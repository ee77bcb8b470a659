#include "frontalis/ros/face_inputs.hpp"

#include "frontalis/error.hpp"
#include "frontalis/ros/conversions.hpp"
#include "frontalis/solver/rigid_motion.hpp"

#include <fmt/format.h>
#include <ros/console.h>

#include <algorithm>
#include <cmath>

namespace frontalis
{

namespace
{

constexpr std::size_t reason_length = 400;    // longest text of a warning, since a message may name a million muscles
constexpr std::size_t most_points = 100'000;  // largest number of points of a trajectory
constexpr double farthest_bone = 0.5;         // largest coordinate of a bone's translation [m]
const ros::WallDuration warning_pause(1);     // between warnings of one topic while reasons change [s]
constexpr double longest_wait = 60;           // longest time until a trajectory begins [s]

void check_lengths(std::size_t names, std::size_t values, std::size_t most, const char* what)
{
  if (names != values)
    throw Error(fmt::format("{} names but {} values; there must be one per name", names, values));
  if (names > 0 && most == 0)
    throw Error(fmt::format("the face has no {}", what));
  if (names > most)
    throw Error(fmt::format("{} names; the face has only {} {}", names, most, what));
}

void check_duration(const char* field, double seconds)
{
  if (!(seconds >= 0) || !std::isfinite(seconds))
    throw Error(fmt::format("{}: found {}; must be 0 or more seconds", field, seconds));
}

// names of the bones that expressions or action units move
std::set<std::string> bones_of_poses(const Model& model)
{
  std::set<std::string> out;
  for (const auto* poses : { &model.expressions, &model.action_units })
    for (const auto& pose : *poses)
      for (const auto& moved : pose.bones)
        out.insert(model.bones[static_cast<std::size_t>(moved.bone)]);
  return out;
}

}  // namespace

void FaceInputs::check_stamp(const ros::Time& stamp) const
{
  // A message without a stamp counts as sent now. Stamps cannot be checked before a simulated clock has begun.
  if (stamp.isZero() || ros::Time::now().isZero())
    return;
  const double age = (ros::Time::now() - stamp).toSec();
  if (std::abs(age) > parameters_.stamp_tolerance)
    throw Error(fmt::format("its stamp is {:.3g} s {}; allowed are {:.3g} s (~stamp_tolerance)", std::abs(age),
                            age > 0 ? "old" : "in the future", parameters_.stamp_tolerance));
}

template <typename Act>
std::string FaceInputs::take(const char* topic, const ros::Time& stamp, const Act& act)
{
  std::string fault;
  const auto running = runner_(&fault);
  const std::lock_guard<std::mutex> lock(mutex_);
  Topic& series = topics_[topic];
  const bool replaced = running && &running->model() != model_.get();
  if (replaced)
    fault = "another face is taking the place of this one";
  if (running && !replaced)
    try
    {
      check_stamp(stamp);
      act(*running, now_());
      ++series.taken;
      series.warned = false;
      return "";
    }
    catch (const std::exception& error)
    {
      fault = error.what();
    }
  if (fault.size() > reason_length)
    fault = fault.substr(0, reason_length) + " ...";
  const ros::WallTime wall = ros::WallTime::now();
  if (!series.warned || (fault != series.told && wall - series.told_at > warning_pause))
  {
    ROS_WARN_STREAM(name_ << ": message on ~" << topic << " refused: " << fault
                          << "; further ones are counted in /diagnostics");
    series.told = fault;
    series.told_at = wall;
  }
  series.warned = true;
  ++series.refused;
  series.reason = fault;
  return fault;
}

void FaceInputs::end_demo(const char* topic)
{
  if (demo_playing_)
    ROS_INFO_STREAM(name_ << ": a message on ~" << topic << " ends the demo; ~reset starts it again");
  demo_playing_ = false;
}

void FaceInputs::command(const char* topic, Runner& running, double now,
                         const std::map<std::string, MuscleCommands::Course>& courses, double begin,
                         std::optional<double> bones_end)
{
  // The message ends the demo. Muscles that it does not name keep their activation in the demo.
  if (demo_playing_)
    commands_->set(demo_->activation(now), now);
  // A motion of bones goes on beside later commands of muscles.
  const double under_way = posed_.empty() ? 0 : bones_.time.back();
  commands_->follow(courses, begin, now, bones_end.value_or(under_way));
  silent_ = false;
  end_demo(topic);
  running.set_activation(commands_->at(now));
}

std::string FaceInputs::set(const char* topic, const ros::Time& stamp, const std::vector<std::string>& names,
                            const std::vector<double>& values)
{
  return take(topic, stamp,
              [&](Runner& running, double now)
              {
                check_lengths(names.size(), values.size(), model_->muscles.size(), "muscles");
                std::map<std::string, MuscleCommands::Course> courses;
                for (std::size_t entry = 0; entry < names.size(); ++entry)
                  if (!courses.emplace(names[entry], MuscleCommands::Course{ { now, values[entry] } }).second)
                    throw Error("muscle '" + names[entry] + "' is named twice");
                command(topic, running, now, courses, now);
              });
}

void FaceInputs::on_muscle_activation(const MuscleActivation& message)
{
  set("muscle_activation", message.header.stamp, message.name, message.activation);
}

void FaceInputs::on_joint_states(const sensor_msgs::JointState& message)
{
  set("joint_states", message.header.stamp, message.name, message.position);
}

void FaceInputs::on_joint_trajectory(const trajectory_msgs::JointTrajectory& message)
{
  const char* const topic = "joint_trajectory";
  // The stamp is the time at which the trajectory begins. It may be in the future, so the message's age is not checked.
  take(topic, ros::Time(),
       [&](Runner& running, double now)
       {
         const std::vector<std::string>& names = message.joint_names;
         check_lengths(names.size(), names.size(), model_->muscles.size(), "muscles");
         if (message.points.size() > most_points)
           throw Error(fmt::format("{} points; allowed are {}", message.points.size(), most_points));
         const double begin =
             message.header.stamp.isZero() ? now : now + (message.header.stamp - ros::Time::now()).toSec();
         if (begin > now + longest_wait)
           throw Error(fmt::format("it begins in {:.3g} s; allowed are {} s", begin - now, longest_wait));
         // The message ends the demo; until the trajectory begins, muscles keep their present activation.
         const auto before_it = present(demo_playing_ ? now : std::max(begin, now));
         std::map<std::string, MuscleCommands::Course> courses;
         for (std::size_t entry = 0; entry < names.size(); ++entry)
         {
           MuscleCommands::Course course;
           if (const auto muscle = before_it.find(names[entry]); muscle != before_it.end())
             course.push_back({ begin, muscle->second });
           double before = -1;
           for (const auto& point : message.points)
           {
             const double after = point.time_from_start.toSec();
             if (point.positions.size() != names.size())
               throw Error(fmt::format("a point has {} positions; there must be one per name, {}",
                                       point.positions.size(), names.size()));
             if (!(after > before) || after < 0)
               throw Error("time_from_start must ascend from 0 or more");
             before = after;
             course.push_back({ begin + after, point.positions[entry] });
           }
           if (begin + std::max(before, 0.0) < now - parameters_.stamp_tolerance)
             throw Error(fmt::format("it ended {:.3g} s ago", now - begin - std::max(before, 0.0)));
           if (!courses.emplace(names[entry], course).second)
             throw Error("muscle '" + names[entry] + "' is named twice");
         }
         command(topic, running, now, courses, begin);
       });
}

void FaceInputs::take_pose(const char* topic, Runner& running, double now, const Controls& pose, const Timing& timing)
{
  std::set<std::string> posed = bones_of_poses(*model_);
  const bool moves_bones = !posed.empty();
  for (const BoneFrame& followed : parameters_.bone_frames)
    posed.erase(followed.bone);
  if (model_->muscles.empty() && moves_bones && posed.empty())
    throw Error("the face has no muscles, and the bones of its expressions follow frames (~bone_frames)");
  const double reached = now + timing.onset, left = reached + timing.hold, over = left + timing.release;
  const auto before = present(now);
  const Controls rest = rest_controls(*model_);
  std::map<std::string, MuscleCommands::Course> courses;
  for (std::size_t muscle = 0; muscle < pose.activation.size(); ++muscle)
  {
    auto& course = courses[model_->muscles[muscle].name];
    course = { { now, before.at(model_->muscles[muscle].name) }, { reached, pose.activation[muscle] } };
    if (timing.hold > 0)
      course.insert(course.end(), { { left, pose.activation[muscle] }, { over, rest.activation[muscle] } });
  }
  ControlCurve bones{ { now, reached }, { present_bones(running, now), pose } };
  if (timing.hold > 0)
  {
    bones.time.insert(bones.time.end(), { left, over });
    bones.controls.insert(bones.controls.end(), { pose, rest });
  }
  command(topic, running, now, courses, now, bones.time.back());
  bones_ = std::move(bones);
  posed_ = std::move(posed);
  set_bones(running, now);
}

void FaceInputs::on_action_units(const ActionUnits& message)
{
  const char* const topic = "action_units";
  take(topic, message.header.stamp,
       [&](Runner& running, double now)
       {
         // A message may name each unit, its left half and its right half.
         check_lengths(message.name.size(), message.intensity.size(), 3 * model_->action_units.size(), "action units");
         std::map<std::string, double> intensities;
         for (std::size_t entry = 0; entry < message.name.size(); ++entry)
           if (!intensities.emplace(message.name[entry], message.intensity[entry]).second)
             throw Error("action unit '" + message.name[entry] + "' is named twice");
         take_pose(topic, running, now, action_unit_controls(*model_, intensities), {});
       });
}

void FaceInputs::on_blendshapes(const Blendshapes& message)
{
  const char* const topic = "blendshapes";
  take(topic, message.header.stamp,
       [&](Runner& running, double now)
       {
         check_lengths(message.name.size(), message.weight.size(), blendshapes_->size(), "blendshapes");
         const std::size_t known = lacking_.size();
         take_pose(topic, running, now, blendshapes_->pose(*model_, message.name, message.weight, lacking_), {});
         if (lacking_.size() > known)
           ROS_WARN_STREAM(name_ << ": nothing of the face moves by the blendshapes "
                                 << fmt::format("{}", fmt::join(lacking_, ", ")) << "; they are ignored");
       });
}

void FaceInputs::on_expression(const Expression& message)
{
  const char* const topic = "expression";
  take(topic, message.header.stamp,
       [&](Runner& running, double now)
       {
         const auto& intensity = message.intensity;
         check_lengths(message.name.size(), intensity.empty() ? message.name.size() : intensity.size(),
                       model_->expressions.size() + 1, "expressions");
         check_duration("onset", message.onset);
         check_duration("hold", message.hold);
         check_duration("release", message.release);
         const Controls rest = rest_controls(*model_);
         Controls sum = rest;
         std::set<std::string> named;
         for (std::size_t entry = 0; entry < message.name.size(); ++entry)
         {
           if (!named.insert(message.name[entry]).second)
             throw Error("expression '" + message.name[entry] + "' is named twice");
           const double share = intensity.empty() ? 1 : intensity[entry];
           if (!(share >= 0 && share <= 1))
             throw Error(fmt::format("intensity of '{}' is {}; must be from 0 to 1", message.name[entry], share));
           const Controls pose = expression_controls(*model_, message.name[entry]);
           for (std::size_t muscle = 0; muscle < sum.activation.size(); ++muscle)
             sum.activation[muscle] += static_cast<float>(share) * (pose.activation[muscle] - rest.activation[muscle]);
           for (std::size_t bone = 0; bone < sum.bone.size(); ++bone)
             sum.bone[bone] = composed(interpolate(RigidTransform(), pose.bone[bone], share), sum.bone[bone]);
         }
         for (float& activation : sum.activation)
           activation = std::clamp(activation, 0.0f, 1.0f);
         take_pose(topic, running, now, sum, { message.onset, message.hold, message.release });
       });
}

void FaceInputs::on_bone_pose(const geometry_msgs::TransformStamped& message)
{
  take("bone_pose", message.header.stamp,
       [&](Runner& running, double now)
       {
         const std::string &bone = message.child_frame_id, &frame = message.header.frame_id;
         if (!frame.empty() && frame != face_frame_)
           throw Error(fmt::format("its frame is '{}'; must be '{}' or empty", frame, face_frame_));
         for (const BoneFrame& followed : parameters_.bone_frames)
           if (followed.bone == bone)
             throw Error("bone '" + bone + "' follows the frame '" + followed.frame + "' (~bone_frames)");
         const geometry_msgs::Vector3& shift = message.transform.translation;
         for (const double coordinate : { shift.x, shift.y, shift.z })
           if (std::abs(coordinate) > farthest_bone)
             throw Error(
                 fmt::format("translation of bone '{}': found {} m; allowed are -{} to {} m (translations are "
                             "in metres)",
                             bone, coordinate, farthest_bone, farthest_bone));
         running.set_bone(bone, to_motion(message.transform));
         posed_.erase(bone);
         if (demo_playing_ && demo_->moves(bone))
         {
           commands_->set(demo_->activation(now), now);
           end_demo("bone_pose");
         }
       });
}

}  // namespace frontalis
