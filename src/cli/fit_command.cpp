#include "cli/command_options.hpp"
#include "cli/model_source.hpp"
#include "cli/progress.hpp"

#include "frontalis/error.hpp"
#include "frontalis/study/calibrate.hpp"

#include <fmt/format.h>

#include <memory>

#include <unistd.h>

namespace frontalis
{
namespace
{

struct FitOptions
{
  ModelSource source;
  std::string request, track;
  std::string json, activations, plot;
  FitSettings settings;
};

std::string in_millimetres(const std::vector<double>& metres)
{
  std::string out;
  for (const double length : metres)
    out += fmt::format("{}{:.3f}", out.empty() ? "" : ", ", 1e3 * length);
  return out + " mm";
}

void show_progress(FitSettings& settings, Progress& progress)
{
  // Without a terminal, progress has one line per stage, so that the stage must include the percentage.
  const bool lines = isatty(STDERR_FILENO) == 0;
  settings.watch = [&progress, lines](const std::string& stage, double done)
  {
    progress.update(lines ? fmt::format("{} {:.0f} %", stage, 100 * done) : stage, done);
    if (interrupt_requested())
      throw Interrupted();
  };
}

void fit_landmarks(FitOptions& options)
{
  const FitRequest request = read_fit_request(options.request);
  if (request.targets.empty())
    throw Error(options.request + ": has no targets; must have landmarks below 'moved' or 'at'");
  check_output(options.json);
  check_output(options.activations);
  const auto model = std::make_shared<const Model>(obtain_model(options.source));
  options.settings.cache = options.source.cache;
  Progress progress;
  show_progress(options.settings, progress);
  const FitResult result = fit(model, request, options.settings);
  progress.clear();
  fmt::print("{}\n{}\n", unknowns_table(result).text(), landmarks_table(result).text());
  if (result.influence_seconds > 0)
    fmt::print("influence  measured in {:.2f} s\n", result.influence_seconds);
  fmt::print("answer     from the influence in {:.4f} s\n", result.linear_seconds);
  if (!result.errors.empty())
    fmt::print("refined    in {:.2f} s; error after each simulation, root mean square: {}\n", result.refinement_seconds,
               in_millimetres(result.errors));
  if (!options.json.empty())
    write_text(options.json, json_of(result));
  if (!options.activations.empty())
    write_text(options.activations, activations_of(result));
}

void retarget_track(FitOptions& options)
{
  // The options are checked before the simulations, which take minutes.
  const std::string plot = plot_path(options.plot);
  check_output(options.activations);
  const FitRequest request = options.request.empty() ? FitRequest() : read_fit_request(options.request);
  if (!request.targets.empty())
    throw Error(options.request + ": has targets; the track has them here, so only unknowns and deviation are allowed");
  const LandmarkTrack track = read_landmark_track(options.track);
  const auto model = std::make_shared<const Model>(obtain_model(options.source));
  options.settings.cache = options.source.cache;
  Progress progress;
  show_progress(options.settings, progress);
  const RetargetResult result = retarget(model, track, request, options.settings);
  progress.clear();
  fmt::print("{}", retarget_table(result).text());
  if (!result.pass_errors.empty())
    fmt::print("error after each simulation, root mean square: {}\n", in_millimetres(result.pass_errors));
  write_text(options.activations, activations_of(result));
  if (!plot.empty())
    write_plot(retarget_plot(result), plot);
}

struct CalibrationOptions : FitOptions
{
  std::string joints, actuators, output;
  int hold_out = 4;
};

void calibrate_robot(CalibrationOptions& options)
{
  check_output(options.output);
  const auto actuators = read_actuators(options.actuators);
  const ActuatorTrack joints = read_actuator_track(options.joints, actuators);
  const LandmarkTrack landmarks = read_landmark_track(options.track);
  const auto model = std::make_shared<const Model>(obtain_model(options.source));
  CalibrationSettings settings{ options.settings, options.hold_out };
  settings.cache = options.source.cache;
  Progress progress;
  show_progress(settings, progress);
  const std::string text = yaml_of(calibrate(model, actuators, joints, landmarks, settings));
  progress.clear();
  fmt::print("{}", text);
  if (!options.output.empty())
    write_text(options.output, text);
}

CLI::App* add_command(CLI::App& app, const std::string& name, const std::string& text, FitOptions& options)
{
  CLI::App* command = app.add_subcommand(name, text);
  command->add_option("SCENE_OR_MODEL", options.source.path, "scene (YAML) or baked model (.vtkhdf)")->required();
  command
      ->add_option("--runs", options.settings.runs, "largest number of simulations that refine the answer (5; 0: none)")
      ->check(CLI::Range(0, 1000));
  command->add_option("--cache", options.source.cache,
                      "folder that keeps baked models and their influence by the content of their scenes");
  add_solver_options(*command, options.settings.solver);
  add_scene_options(*command, options.source);
  return command;
}

}  // namespace

void add_fit_command(CLI::App& app)
{
  const auto options = std::make_shared<FitOptions>();
  CLI::App* command =
      add_command(app, "fit", "find the activations that bring landmarks to given places, in equilibrium", *options);
  command->add_option("--target", options->request, "file of targets and unknowns (YAML, doc/fitting.md)")->required();
  command->add_option("--json", options->json, "write the answer, with its covariance, to this file");
  command->add_option("--activations", options->activations,
                      "write the answer to this table (CSV), for frontalis run --activations");
  command->callback([options] { fit_landmarks(*options); });
}

void add_retarget_command(CLI::App& app)
{
  const auto options = std::make_shared<FitOptions>();
  CLI::App* command = add_command(app, "retarget",
                                  "find activations over time under which a face follows recorded landmarks", *options);
  command
      ->add_option("TRACK", options->track,
                   "table (CSV) with the columns time_s, landmark, forward_mm, left_mm, up_mm, such as landmarks.csv "
                   "of frontalis run --frames")
      ->required();
  command->add_option("-o,--activations", options->activations, "table to write (CSV)")->required();
  command->add_option("--unknowns", options->request, "file with unknowns and deviation, as that of fit --target");
  command->add_option("--plot", options->plot, "draw the errors over time: FILE.png, and FILE.svg beside it");
  options->settings.runs = 3;
  command->get_option("--runs")->description("simulations of the whole track that correct the answer (3; 0: none)");
  command->callback([options] { retarget_track(*options); });
}

void add_calibrate_command(CLI::App& app)
{
  const auto options = std::make_shared<CalibrationOptions>();
  CLI::App* command = add_command(
      app, "calibrate", "find gains of a robot's actuators and the modulus of its skin from babbled poses", *options);
  command
      ->add_option("JOINTS", options->joints,
                   "table (CSV) of poses: time_s, the position of each actuator, and ACTUATOR.effort where it is known")
      ->required();
  command->add_option("LANDMARKS", options->track, "table (CSV) of the landmarks at these times, as that of retarget")
      ->required();
  command->add_option("--actuators", options->actuators, "file of actuators and the motion they should cause (YAML)")
      ->required();
  command->add_option("-o,--output", options->output, "file to write the answer to (YAML), as --actuators takes it");
  command->add_option("--hold-out", options->hold_out, "hold out one in so many poses, to test the answer (4; 0: none)")
      ->check(CLI::Range(2, 1000) | CLI::IsMember({ 0 }));
  options->settings.runs = 1;
  command->get_option("--runs")->description("simulations of every pose that correct the answer (1; 0: none)");
  command->callback([options] { calibrate_robot(*options); });
}

}  // namespace frontalis
