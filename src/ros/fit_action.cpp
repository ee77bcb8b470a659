#include "frontalis/ros/fit_action.hpp"

#include "frontalis/error.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>

namespace frontalis
{
namespace
{

constexpr double millimetres = 1e3;
// Largest coordinates of a target [m]: what is larger is probably in millimetres.
constexpr double farthest = 0.1, farthest_place = 1;

void check_length(const std::string& field, std::size_t found, std::size_t wanted, const std::string& of)
{
  if (found != wanted)
    throw Error(fmt::format("{}: found {} entries; must be {}, one per {}", field, found, wanted, of));
}

// The goal as the text of a file of targets. Names are quoted, so that no name changes the file's structure.
std::string request_of(const FitActivationGoal& goal)
{
  check_length("target", goal.target.size(), goal.landmark.size(), "landmark");
  std::set<std::string> named;
  bool any = false;
  const double most = goal.place ? farthest_place : farthest;
  for (std::size_t l = 0; l < goal.landmark.size(); ++l)
  {
    if (!named.insert(goal.landmark[l]).second)
      throw Error("landmark '" + goal.landmark[l] + "' is named twice");
    for (const double x : { goal.target[l].x, goal.target[l].y, goal.target[l].z })
    {
      any = any || !std::isnan(x);
      if (std::abs(x) > most)
        throw Error(fmt::format(
            "target of landmark '{}': found {} m; allowed are -{} to {} m (targets are in metres; NaN leaves one free)",
            goal.landmark[l], x, most, most));
    }
  }
  if (!any)
    throw Error("there are no targets: every coordinate is missing");
  if (!(goal.deviation >= 0 && std::isfinite(goal.deviation)))
    throw Error(fmt::format("deviation: found {} m; must be above 0, or 0 for the default", goal.deviation));
  YAML::Emitter text;
  const auto coordinate = [&](double value)
  {
    if (std::isnan(value))
      text << YAML::Null;
    else
      text << millimetres * value;
  };
  text << YAML::DoublePrecision(12) << YAML::BeginMap;
  if (goal.deviation != 0)
    text << YAML::Key << "deviation" << YAML::Value << millimetres * goal.deviation;
  text << YAML::Key << (goal.place ? "at" : "moved") << YAML::Value << YAML::BeginMap;
  for (std::size_t l = 0; l < goal.landmark.size(); ++l)
  {
    text << YAML::Key << YAML::DoubleQuoted << goal.landmark[l] << YAML::Value << YAML::Flow << YAML::BeginSeq;
    for (const double value : { goal.target[l].x, goal.target[l].y, goal.target[l].z })
      coordinate(value);
    text << YAML::EndSeq;
  }
  text << YAML::EndMap;
  if (!goal.unknown.empty())
  {
    const bool limited = !goal.lower.empty() || !goal.upper.empty();
    const auto bone = std::find_if(goal.unknown.begin(), goal.unknown.end(),
                                   [](const std::string& name) { return name.find('.') != std::string::npos; });
    if (bone != goal.unknown.end() && goal.apply)
      throw Error("apply: a face takes muscles only, but the unknown '" + *bone + "' is a motion of a bone");
    if (bone != goal.unknown.end() && !limited)
      throw Error("unknown '" + *bone + "': a motion of a bone needs limits, in 'lower' and 'upper'");
    if (limited)
    {
      check_length("lower", goal.lower.size(), goal.unknown.size(), "unknown");
      check_length("upper", goal.upper.size(), goal.unknown.size(), "unknown");
    }
    text << YAML::Key << "unknowns" << YAML::Value << YAML::BeginMap;
    for (std::size_t i = 0; i < goal.unknown.size(); ++i)
      text << YAML::Key << YAML::DoubleQuoted << goal.unknown[i] << YAML::Value << YAML::Flow << YAML::BeginSeq
           << (limited ? goal.lower[i] : 0.0) << (limited ? goal.upper[i] : 1.0) << YAML::EndSeq;
    text << YAML::EndMap;
  }
  text << YAML::EndMap;
  return text.c_str();
}

FitActivationResult result_from(const std::string& path)
{
  const YAML::Node json = YAML::LoadFile(path);
  FitActivationResult out;
  for (const auto& unknown : json["unknowns"])
  {
    out.name.push_back(unknown["name"].as<std::string>());
    out.value.push_back(unknown["value"].as<double>());
    out.deviation.push_back(unknown["sd"].as<double>());
    out.determined.push_back(unknown["determined"].as<bool>() ? 1 : 0);
    out.like.push_back(unknown["like"].as<std::string>());
  }
  for (const auto& row : json["covariance"])
    for (const auto& entry : row)
      out.covariance.push_back(entry.as<double>());
  for (const auto& landmark : json["landmarks"])
    out.error.push_back(landmark["error_m"].as<double>());
  out.errors = json["errors_m"].as<std::vector<double>>();
  out.influence_seconds = json["influence_s"].as<double>();
  out.linear_seconds = json["linear_s"].as<double>();
  out.refinement_seconds = json["refinement_s"].as<double>();
  return out;
}

}  // namespace

FitAction::FitAction(const ros::NodeHandle& private_handle, FindFace face, Apply apply)
    : face_(std::move(face)),
      apply_(std::move(apply)),
      server_(
          private_handle, "fit_activation", [this](const FitActivationGoalConstPtr& goal) { execute(goal); }, false)
{
  server_.registerPreemptCallback([this] { cancelled_ = true; });
  server_.start();
}

FitAction::~FitAction()
{
  stopping_ = true;
  cancelled_ = true;
  server_.shutdown();
}

void FitAction::execute(const FitActivationGoalConstPtr& goal)
{
  // This is cleared before the check, so that a goal that is cancelled at this moment stays cancelled.
  cancelled_ = false;
  if (stopping_ || server_.isPreemptRequested())
    cancelled_ = true;
  try
  {
    const Face face = face_();
    const FitActivationResult result = answer(*goal, face);
    if (goal->apply)
    {
      if (const Face now = face_(); now.model != face.model || now.source.scene != face.source.scene)
        throw Error("another face was loaded meanwhile, so that the result was not applied");
      if (const std::string fault = apply_(result.name, result.value); !fault.empty())
        throw Error("the face refused the result: " + fault);
    }
    server_.setSucceeded(result);
  }
  catch (const std::exception& error)
  {
    if (cancelled_)
      server_.setPreempted({}, "the goal was cancelled");
    else
      server_.setAborted({}, error.what());
  }
}

FitActivationResult FitAction::answer(const FitActivationGoal& goal, const Face& face)
{
  const auto folder = temporary_folder();
  const std::string request = *folder / "targets.yaml", result = *folder / "result.json";
  std::ofstream(request) << request_of(goal);
  std::vector<std::string> arguments{ "fit",      face.model.empty() ? face.source.scene : face.model,
                                      "--target", request,
                                      "--json",   result };
  if (goal.runs >= 0)
    arguments.insert(arguments.end(), { "--runs", std::to_string(goal.runs) });
  if (face.model.empty())
    add_scene_arguments(face.source, arguments);
  else if (!face.source.cache.empty())
    arguments.insert(arguments.end(), { "--cache", face.source.cache });
  arguments.insert(arguments.end(), face.options.begin(), face.options.end());
  const auto report = [this](const std::string& line)
  {
    // lines of progress end in " ..."
    const std::size_t end = line.rfind(" ...");
    if (end == std::string::npos || end + 4 != line.size())
      return;
    FitActivationFeedback feedback;
    feedback.stage = line.substr(0, end);
    server_.publishFeedback(feedback);
  };
  run_program(find_program(face.source.program), arguments, report, cancelled_);
  return result_from(result);
}

}  // namespace frontalis
