#include "frontalis/ros/face_node.hpp"

#include "frontalis/error.hpp"
#include "frontalis/model/effects.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <sstream>

namespace frontalis
{

namespace
{

constexpr double piece = 1.0 / 30;  // length of the pieces of a ~step while activations may change [s]

}  // namespace

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

void FaceNode::note_pause()
{
  if (const auto present = runner())
    paused_ = present->paused();
}

bool FaceNode::on_reset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response)
{
  return answer(response,
                [&](Runner& running)
                {
                  ++resets_;
                  inputs_.reset(running);
                  note_pause();
                });
}

bool FaceNode::on_pause(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response)
{
  return answer(response,
                [&](Runner& running)
                {
                  running.pause(request.data);
                  note_pause();
                  const std::lock_guard<std::mutex> lock(frame_mutex_);
                  if (!request.data && parameters_.runner.pace == Pace::lock_step)
                    response.message = "~pace is lock_step: the face moves in ~step alone";
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
        const std::unique_lock<std::mutex> one_at_a_time(stepping_mutex_, std::try_to_lock);
        if (!one_at_a_time)
          throw Error("another step is under way");
        struct AtTheEnd
        {
          FaceNode& node;
          ~AtTheEnd() { node.note_pause(); }
        } const at_the_end{ *this };
        Frame frame;
        frame.time = time_;
        double left = request.seconds;
        const std::uint64_t resets = resets_;
        do
        {
          // Between two pieces no runner is there that could end the step.
          if (resets_ != resets || runner().get() != &running)
            throw Error("the step was ended early");
          paused_ = true;  // set before the step, because its frames report it
          const double seconds = inputs_.timed(frame.time) && left > piece ? piece : left;
          inputs_.play(running, frame.time + seconds);
          left -= seconds;
          // The clock may stand still during a step. Frames of its pieces would then have the same stamp.
          frame = running.step(seconds, left <= 0);
        } while (left > 0 && !frame.failed && !stopping_);
        if (left > 0 && !frame.failed)
          throw Error("the step was ended early");
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
                  const Model& model = running.model();
                  const auto target = inputs_.target(time_);
                  response.activation.resize(model.muscles.size(), 0.0);
                  for (const auto& muscle : model.muscles)
                  {
                    response.name.push_back(muscle.name);
                    const auto commanded = target.find(muscle.name);
                    response.target.push_back(commanded == target.end() ? 0 : commanded->second);
                  }
                  for (const auto& expression : model.expressions)
                    response.expressions.push_back(expression.name);
                  response.expressions.push_back("relax");
                  response.messages = inputs_.messages();
                  response.stamp = ros::Time::now();
                  for (const auto& unit : model.action_units)
                    response.action_units.push_back(unit.name);
                });
}

bool FaceNode::on_load_scene(LoadScene::Request& request, LoadScene::Response& response)
{
  const std::lock_guard<std::mutex> one_at_a_time(loading_mutex_);
  try
  {
    if (request.scene.empty())
      throw Error("scene: found nothing; must be the path of a scene file or of a baked model (.vtkhdf)");
    FaceParameters parameters = read_parameters(private_handle_, false);
    const bool baked = std::filesystem::path(request.scene).extension() == ".vtkhdf";
    parameters.model = baked ? request.scene : "";
    parameters.bake.scene = request.scene;
    parameters.bake.mesh_directory = request.mesh_dir;
    parameters.bake.accuracy = request.accuracy;
    replace_face(parameters);
    response.success = true;
  }
  catch (const std::exception& error)
  {
    response.message = error.what();
    ROS_WARN_STREAM(name_ << ": ~load_scene changes nothing: " << response.message);
  }
  return true;
}

bool FaceNode::on_probe(Probe::Request& request, Probe::Response& response)
{
  return answer(response,
                [&](const Runner&)
                {
                  const std::lock_guard<std::mutex> lock(frame_mutex_);
                  if (!has_frame_ || !frame_finite_)
                    throw Error("there is no frame yet");
                  response.time = frame_.time;
                  publisher_.probe(frame_.skin, request.point, response);
                });
}

FitAction::Face FaceNode::fitted_face() const
{
  std::string reason;
  if (!runner(&reason))
    throw Error(reason);
  const std::lock_guard<std::mutex> lock(runner_mutex_);
  const SolverSettings& solver = parameters_.runner.solver;
  return { parameters_.bake,
           parameters_.model,
           { "--backend", solver.backend, "--threads", std::to_string(solver.threads) } };
}

void FaceNode::on_config(FaceConfig& config, std::uint32_t)
{
  const auto running = runner();
  if (!running)
    return;
  try
  {
    apply_config(*running, config);
    config_ = config;
  }
  catch (const Error& error)
  {
    ROS_WARN_STREAM(name_ << ": configuration refused: " << error.what());
    // Applying the old configuration undoes the changes made before the fault was found. Of the first configuration,
    // only effects that the face cannot be without are left to be refused (read_parameters).
    if (config_)
      config = *config_;
    else
      config.effects_off.clear();
    try
    {
      apply_config(*running, config);
      config_ = config;
    }
    catch (const Error& again)
    {
      ROS_WARN_STREAM(name_ << ": the configuration before could not be restored whole: " << again.what());
    }
  }
}

void FaceNode::apply_config(Runner& running, const FaceConfig& config)
{
  for (const auto& [name, number] : { std::pair<const char*, double>{ "frame_rate", config.frame_rate },
                                      { "colour_range", config.colour_range },
                                      { "damping", config.damping },
                                      { "command_timeout", config.command_timeout },
                                      { "relax_time", config.relax_time },
                                      { "stamp_tolerance", config.stamp_tolerance },
                                      { "real_time_factor_warning", config.real_time_factor_warning } })
    if (!std::isfinite(number))
      throw Error(fmt::format("{}: found {}; must be finite", name, number));
  const SkinColour colour = skin_colour_from_name(config.skin_colour);
  const SkinField field = skin_field_from_name(config.skin_field);
  std::set<std::string> off;
  std::istringstream words(config.effects_off);
  for (std::string word; words >> word;)
    off.insert(name_of(effect_from_name(word)));
  running.set_frame_rate(config.frame_rate);
  running.set_damping(config.damping);
  // Effects that this configuration does not change are left alone: ~switch_effect may have switched them.
  const EffectSet present = effects_of(running.model());
  const auto switch_to = [&](Effect effect, bool on)
  {
    const bool is_on = switched_off_.count(name_of(effect)) == 0, wanted = off.count(name_of(effect)) == 0;
    if (!present.has(effect) || wanted != on || is_on == on)
      return;
    running.switch_effect(effect, on);
    if (on)
      switched_off_.erase(name_of(effect));
    else
      switched_off_.insert(name_of(effect));
  };
  // An effect may need an earlier one.
  const auto effects = every_effect();
  for (auto effect = std::rbegin(effects); effect != std::rend(effects); ++effect)
    switch_to(*effect, false);
  for (const Effect effect : effects)
    switch_to(effect, true);
  InputParameters inputs;
  {
    const std::scoped_lock lock(runner_mutex_, frame_mutex_);
    publisher_.set_colour(colour, field, config.colour_range);
    parameters_.real_time_factor_warning = config.real_time_factor_warning;
    parameters_.inputs.command_timeout = config.command_timeout;
    parameters_.inputs.relax_time = config.relax_time;
    parameters_.inputs.stamp_tolerance = config.stamp_tolerance;
    inputs = parameters_.inputs;
  }
  inputs_.configure(inputs);
}

}  // namespace frontalis
