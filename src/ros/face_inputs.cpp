#include "frontalis/ros/face_inputs.hpp"

#include "frontalis/error.hpp"
#include "frontalis/ros/conversions.hpp"
#include "frontalis/runner/named_controls.hpp"

#include <fmt/format.h>
#include <ros/console.h>

#include <algorithm>
#include <cmath>

namespace frontalis
{

namespace
{

constexpr std::size_t reason_length = 400;    // a message may name a million muscles: a warning shows the beginning
constexpr std::size_t most_points = 100'000;  // of a trajectory
constexpr double longest_wait = 60;           // for the beginning of a trajectory [s]

void check_lengths(std::size_t names, std::size_t values, std::size_t most)
{
  if (names != values)
    throw Error(fmt::format("{} names but {} values; there must be one per name", names, values));
  if (names > most)
    throw Error(fmt::format("{} names; there are only {}", names, most));
}

void check_duration(const char* field, double seconds)
{
  if (!(seconds >= 0) || !std::isfinite(seconds))
    throw Error(fmt::format("{}: found {}; must be 0 or more seconds", field, seconds));
}

}  // namespace

FaceInputs::FaceInputs(ros::NodeHandle private_handle, const std::string& name, FindRunner runner,
                       std::function<double()> now)
    : name_(name), runner_(std::move(runner)), now_(std::move(now))
{
  const auto subscribe = [&](const char* topic, auto handler)
  { subscribers_.push_back(private_handle.subscribe(topic, 10, handler, this)); };
  subscribe("muscle_activation", &FaceInputs::on_muscle_activation);
  subscribe("joint_states", &FaceInputs::on_joint_states);
  subscribe("joint_trajectory", &FaceInputs::on_joint_trajectory);
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
                              fmt::join(model->bones, ", ")));
  auto follower = std::make_unique<BoneFollower>(parameters.bone_frames, face_frame, parameters.bone_speed,
                                                 parameters.stamp_tolerance);
  auto demo = std::make_unique<DemoPlayer>(model);
  const std::lock_guard<std::mutex> lock(mutex_);
  model_ = model;
  parameters_ = parameters;
  demo_ = std::move(demo);
  demo_playing_ = parameters.demo && !demo_->empty();
  commands_ = std::make_unique<MuscleCommands>(model);
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
}

void FaceInputs::reset(Runner& running)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  running.reset();
  commands_->clear();
  silent_ = false;
  demo_playing_ = parameters_.demo && !demo_->empty();
  follower_->clear();
  followed_ = 0;
}

void FaceInputs::play(Runner& running, double time)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  if (&running.model() != model_.get())
    return;  // another scene is being loaded
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
      ROS_WARN_STREAM(name_ << ": no command for " << parameters_.command_timeout << " s: the face relaxes over "
                            << parameters_.relax_time << " s");
    }
    running.set_activation(commands_->at(time));
  }
  if (time > followed_)
  {
    for (const auto& [bone, motion] : follower_->follow(time - followed_))
      running.set_bone(bone, motion);
    followed_ = time;
  }
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

// messages
// -------------------------------------------------------------------------------------------------------------

void FaceInputs::check_stamp(const ros::Time& stamp) const
{
  // a message without a stamp is of now; a simulated clock that has not begun tells nothing
  if (stamp.isZero() || ros::Time::now().isZero())
    return;
  const double age = (ros::Time::now() - stamp).toSec();
  if (std::abs(age) > parameters_.stamp_tolerance)
    throw Error(fmt::format("its stamp is {:.3g} s {}; allowed are {:.3g} s (~stamp_tolerance)", std::abs(age),
                            age > 0 ? "old" : "in the future", parameters_.stamp_tolerance));
}

template <typename Act>
void FaceInputs::take(const char* topic, const ros::Time& stamp, const Act& act)
{
  std::string fault;
  const auto running = runner_(&fault);
  const std::lock_guard<std::mutex> lock(mutex_);
  Topic& series = topics_[topic];
  if (running)
    try
    {
      check_stamp(stamp);
      act(*running, now_());
      ++series.taken;
      series.warned = false;
      return;
    }
    catch (const std::exception& error)
    {
      fault = error.what();
    }
  if (fault.size() > reason_length)
    fault = fault.substr(0, reason_length) + " ...";
  if (!series.warned)
    ROS_WARN_STREAM(name_ << ": message on ~" << topic << " refused: " << fault
                          << "; further ones are counted in /diagnostics");
  series.warned = true;
  ++series.refused;
  series.reason = fault;
}

std::map<std::string, double> FaceInputs::present(double time) const
{
  return demo_playing_ ? demo_->activation(time) : commands_->at(time);
}

void FaceInputs::end_demo(const char* topic)
{
  if (demo_playing_)
    ROS_INFO_STREAM(name_ << ": a message on ~" << topic << " ends the demo; ~reset starts it again");
  demo_playing_ = false;
}

void FaceInputs::command(const char* topic, Runner& running, double now,
                         const std::map<std::string, MuscleCommands::Course>& courses, double begin)
{
  // muscles that this message does not name stay where the demo has them
  if (demo_playing_)
    commands_->set(demo_->activation(now), now);
  commands_->follow(courses, begin, now);
  silent_ = false;
  end_demo(topic);
  running.set_activation(commands_->at(now));
}

void FaceInputs::set(const char* topic, const ros::Time& stamp, const std::vector<std::string>& names,
                     const std::vector<double>& values)
{
  take(topic, stamp,
       [&](Runner& running, double now)
       {
         check_lengths(names.size(), values.size(), model_->muscles.size());
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
  // its stamp is the time at which it begins, so that it may be in the future
  take(topic, ros::Time(),
       [&](Runner& running, double now)
       {
         const std::vector<std::string>& names = message.joint_names;
         check_lengths(names.size(), names.size(), model_->muscles.size());
         if (message.points.size() > most_points)
           throw Error(fmt::format("{} points; allowed are {}", message.points.size(), most_points));
         const double begin =
             message.header.stamp.isZero() ? now : now + (message.header.stamp - ros::Time::now()).toSec();
         if (begin > now + longest_wait)
           throw Error(fmt::format("it begins in {:.3g} s; allowed are {} s", begin - now, longest_wait));
         const auto before_it = present(std::max(begin, now));
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

void FaceInputs::on_blendshapes(const Blendshapes& message)
{
  const char* const topic = "blendshapes";
  take(topic, message.header.stamp,
       [&](Runner& running, double now)
       {
         check_lengths(message.name.size(), message.weight.size(), blendshapes_->size());
         const std::size_t known = lacking_.size();
         std::map<std::string, MuscleCommands::Course> courses;
         for (const auto& [muscle, value] : blendshapes_->activation(message.name, message.weight, lacking_))
           courses[muscle] = { { now, value } };
         if (lacking_.size() > known)
           ROS_WARN_STREAM(name_ << ": the face has no muscles for the blendshapes "
                                 << fmt::format("{}", fmt::join(lacking_, ", ")) << "; they are ignored");
         command(topic, running, now, courses, now);
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
                       model_->expressions.size() + 1);
         check_duration("onset", message.onset);
         check_duration("hold", message.hold);
         check_duration("release", message.release);
         const std::vector<float> tone = rest_controls(*model_).activation;
         std::vector<double> sum(tone.begin(), tone.end());
         for (std::size_t entry = 0; entry < message.name.size(); ++entry)
         {
           const double share = intensity.empty() ? 1 : intensity[entry];
           if (!(share >= 0 && share <= 1))
             throw Error(fmt::format("intensity of '{}' is {}; must be from 0 to 1", message.name[entry], share));
           const auto activation = expression_controls(*model_, message.name[entry]).activation;
           for (std::size_t muscle = 0; muscle < sum.size(); ++muscle)
             sum[muscle] += share * (activation[muscle] - tone[muscle]);
         }
         const auto before = present(now);
         std::map<std::string, MuscleCommands::Course> courses;
         for (std::size_t muscle = 0; muscle < sum.size(); ++muscle)
         {
           const std::string& name = model_->muscles[muscle].name;
           const double value = std::clamp(sum[muscle], 0.0, 1.0), held = now + message.onset;
           auto& course = courses[name];
           course = { { now, before.at(name) }, { held, value } };
           if (message.hold > 0)
             course.insert(course.end(),
                           { { held + message.hold, value }, { held + message.hold + message.release, tone[muscle] } });
         }
         command(topic, running, now, courses, now);
       });
}

void FaceInputs::on_bone_pose(const geometry_msgs::TransformStamped& message)
{
  take("bone_pose", message.header.stamp,
       [&](Runner& running, double now)
       {
         const std::string& bone = message.child_frame_id;
         for (const BoneFrame& followed : parameters_.bone_frames)
           if (followed.bone == bone)
             throw Error("bone '" + bone + "' follows the frame '" + followed.frame + "' (~bone_frames)");
         running.set_bone(bone, to_motion(message.transform));
         if (demo_playing_ && demo_->moves(bone))
         {
           commands_->set(demo_->activation(now), now);
           end_demo("bone_pose");
         }
       });
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
