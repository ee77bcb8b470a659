#include "cli/activation_list.hpp"
#include "cli/command.hpp"
#include "cli/frame_folder.hpp"
#include "cli/interrupt.hpp"
#include "cli/model_source.hpp"
#include "cli/motion.hpp"
#include "cli/progress.hpp"
#include "cli/reactions.hpp"
#include "cli/run_summary.hpp"
#include "cli/solver_options.hpp"

#include "frontalis/error.hpp"
#include "frontalis/runner/face_frame.hpp"
#include "frontalis/study/step_time.hpp"

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

namespace frontalis
{
namespace
{

struct RunOptions
{
  ModelSource source;
  std::string activation;
  std::string expression;
  std::string activation_file;
  std::vector<std::string> bones;
  std::vector<std::string> without;
  bool to_equilibrium = false;
  double tolerance = 1e-3;
  bool ledger = false;
  double ramp = -1;  ///< [s]; < 0: 0.1 s, or half of the run if that is less
  double seconds = 1;
  std::string frames;
  double frame_rate = 0;  ///< [1/s]; 0: the model's
  SolverOptions solver;
  double time_step = 0;     ///< [s]; 0: found by the solver
  int guard_interval = -1;  ///< steps; 0: no guard; -1: the backend's default
};

// Ends the run before a frame of a diverged motion is written.
void check_motion(const Monitor& monitor, const SkinState& skin, double time)
{
  if (!monitor.finite || !is_finite(skin))
    throw Error(
        fmt::format("the motion diverged at {:g} s: displacements are no longer finite; use a smaller "
                    "time_step_share, smaller activations or more damping",
                    time));
}

void look(Solver& solver, const Model& model, double time, RunSummary& summary)
{
  solver.skin(summary.end);
  summary.monitor = solver.monitor();
  if (summary.ledger)
    summary.ledger = solver.ledger();
  check_motion(summary.monitor, summary.end, time);
  summary.reactions = reactions_in_face_frame(solver, model);
  to_face_frame(model, summary.end);
  summary.seconds = time;
  summary.time_step = solver.time_step();
  summary.profile = solver.profile();
  summary.peak_kinetic = std::max(summary.peak_kinetic, summary.monitor.kinetic);
  summary.peak_internal = std::max(summary.peak_internal, summary.monitor.internal);
  summary.worst_jacobian = std::min(summary.worst_jacobian, summary.monitor.worst_jacobian);
}

// plays the motion frame by frame; ends early on Ctrl-C
void play(Solver& solver, const Guard* guard, const Model& model, const RunOptions& options, Motion& motion,
          std::optional<FrameFolder>& folder, RunSummary& summary)
{
  const double frame_rate = options.frame_rate > 0 ? options.frame_rate : model.frame_rate;
  const auto frames = static_cast<int>(std::max(1.0, std::ceil(options.seconds * frame_rate * (1 - 1e-9))));
  const double begin = wall_seconds();
  Progress progress;
  for (int frame = 0; frame <= frames; ++frame)
  {
    motion.advance_to(frame == frames ? options.seconds : frame / frame_rate);
    const double time = motion.time();
    look(solver, model, time, summary);
    if (guard != nullptr)
      summary.guard = guard->counts();
    if (frame == 0)
      summary.rest = summary.end;
    if (folder)
      folder->add(time, summary.end, summary.reactions);
    summary.frames = frame + 1;
    summary.wall = wall_seconds() - begin;
    progress.update("running", static_cast<double>(frame) / frames);
    if (time < options.seconds && interrupt_requested())
    {
      summary.complete = false;
      break;
    }
  }
}

// relaxes to equilibrium under the final activations
void settle(Solver& solver, Guard* guard, const Model& model, const RunOptions& options, const Controls& target,
            std::optional<FrameFolder>& folder, RunSummary& summary)
{
  const double begin = wall_seconds();
  look(solver, model, 0, summary);
  summary.rest = summary.end;
  Progress progress;
  const double seconds = options.seconds / model.time_scaling;
  const auto go_on = [&](const Equilibrium& now)
  {
    progress.update("relaxing", now.seconds / seconds);
    return !interrupt_requested();
  };
  const Equilibrium found = guard != nullptr ? guard->settle(target, options.tolerance, seconds, go_on)
                                             : solver.settle(target, options.tolerance, seconds, go_on);
  const double time = found.seconds * model.time_scaling;
  look(solver, model, time, summary);
  summary.frames = 1;
  summary.wall = wall_seconds() - begin;
  summary.equilibrium = found;
  summary.complete = !interrupt_requested() || found.reached;
  if (folder)
    folder->add(time, summary.end, summary.reactions);
}

void check_options(const RunOptions& options)
{
  if (!options.activation_file.empty() && (!options.activation.empty() || !options.expression.empty()))
    throw WrongUsage("--activations goes with neither --activate nor --expression");
  if (options.to_equilibrium && options.ledger)
    throw WrongUsage("--ledger: energies do not balance on the way to equilibrium");
  check_seconds(options.seconds);
  if (!std::isfinite(options.ramp))
    throw WrongUsage("--ramp: must be a number from 0");
  if (!(options.frame_rate >= 0) || !std::isfinite(options.frame_rate))
    throw WrongUsage("--frame-rate: must be a number greater than 0");
  if (options.seconds * std::max(options.frame_rate, 1.0) > 1e6)
    throw WrongUsage("--seconds times --frame-rate: more than a million frames");
}

// in reverse order, since an effect comes after those that it needs
void switch_off(Solver& solver, EffectSet off)
{
  const auto effects = every_effect();
  for (auto effect = effects.rbegin(); effect != effects.rend(); ++effect)
    if (off.has(*effect))
      solver.switch_effect(*effect, false);
}

void run(const RunOptions& options)
{
  check_options(options);
  const std::map<std::string, double> listed = parse_activation_list(options.activation);
  SolverSettings settings = options.solver.settings();
  settings.time_step = options.time_step;
  settings.ledger = options.ledger;
  EffectSet off;
  for (const std::string& name : options.without)
    off = off.with(effect_from_name(name));

  const auto model = std::make_shared<const Model>(obtain_model(options.source));
  const double ramp = options.ramp < 0 ? std::min(0.1, options.seconds / 2) : options.ramp;
  const ActivationCurve curve = options.activation_file.empty()
                                    ? ramp_to(target_activation(*model, options.expression, listed), ramp)
                                    : read_activation_curve(options.activation_file, *model);
  const std::vector<RigidTransform> bones = parse_bone_motions(*model, options.bones);
  std::optional<FrameFolder> folder;
  if (!options.frames.empty())
    folder.emplace(options.frames, *model);

  const std::unique_ptr<Solver> solver = make_solver(model, settings);
  switch_off(*solver, off);
  RunSummary summary;
  if (options.ledger)
    summary.ledger.emplace();
  summary.backend = solver->description();
  summary.time_step = solver->time_step();
  print_set_up(*model, summary);

  std::optional<Guard> guard;
  if (options.guard_interval != 0)
  {
    GuardSettings watch;
    watch.interval = std::max(options.guard_interval, 0);
    watch.ledger = options.ledger;
    guard.emplace(*solver, model, watch);
  }
  Guard* const watched = guard ? &*guard : nullptr;
  try
  {
    if (options.to_equilibrium)
      settle(*solver, watched, *model, options, { curve.activation.back(), bones }, folder, summary);
    else
    {
      Motion motion(*solver, watched, *model, curve, bones, ramp, [] { return !interrupt_requested(); });
      play(*solver, watched, *model, options, motion, folder, summary);
    }
  }
  catch (const Error& error)
  {
    // the result up to here is written before the error is told
    summary.complete = false;
    summary.failure = error.what();
    if (folder)
      folder->finish(json_of(*model, summary));
    throw;
  }
  if (folder)
    folder->finish(json_of(*model, summary));
  print_result(*model, summary);
  if (!summary.complete)
    throw Interrupted();
  if (summary.equilibrium && !summary.equilibrium->reached)
    throw Error(
        fmt::format("no equilibrium after {:g} s of relaxation: {:.3g} of the displacement is left; allow more "
                    "--seconds or a larger --tolerance",
                    options.seconds, summary.equilibrium->residual));
}

}  // namespace

void add_run_command(CLI::App& app, Action& action)
{
  CLI::App* command = app.add_subcommand("run", "simulate a scene or a baked model and print how its landmarks moved");
  const auto options = std::make_shared<RunOptions>();
  command->add_option("SCENE_OR_MODEL", options->source.path, "scene (YAML) or baked model (.vtkhdf)")->required();
  command->add_option("--activate", options->activation, "activations from 0 to 1: MUSCLE=VALUE,MUSCLE=VALUE,...");
  command->add_option("--expression", options->expression,
                      "a named set of activations, over which --activate takes precedence");
  command->add_option("--activations", options->activation_file,
                      "activations over time: a table (CSV) with a column time [s] and one column per muscle");
  command->add_flag("--to-equilibrium", options->to_equilibrium,
                    "relax to equilibrium under the final activations, within --seconds (10)");
  command
      ->add_option("--tolerance", options->tolerance,
                   "of equilibrium: remaining motion divided by displacement (0.001)")
      ->check(CLI::PositiveNumber);
  command->add_flag("--ledger", options->ledger, "keep the energy ledger and print it");
  command->add_option("--bone", options->bones,
                      "motion of a bone in the face frame: NAME=X,Y,Z,RX,RY,RZ, shift [mm] and rotation vector about "
                      "the origin [degrees]; once per bone");
  command
      ->add_option("--ramp", options->ramp,
                   "seconds over which activations and bones move linearly (0.1, or half of the run)")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--without", options->without, "effects to switch off: NAME,NAME,... (see frontalis effects)")
      ->delimiter(',');
  command->add_option("--seconds", options->seconds, "simulated seconds (1)")->check(CLI::PositiveNumber);
  command->add_option("--frames", options->frames,
                      "folder for skin_NNNN.ply, landmarks.csv, reactions.csv (of bodies that tissue touches) and "
                      "run.json; files of an earlier run are replaced");
  command->add_option("--frame-rate", options->frame_rate, "frames per simulated second (as the model says)")
      ->check(CLI::PositiveNumber);
  add_solver_options(*command, options->solver);
  command
      ->add_option(
          "--guard", options->guard_interval,
          "steps between two checks of the motion (512, on a GPU 2048; 0: no checks); an unstable motion goes back "
          "to the last good check and takes shorter steps")
      ->check(CLI::Range(0, 1 << 30));
  command->add_option("--time-step", options->time_step,
                      "longest time step [s], at most the critical one (0: the safe one, by the model's share of it)");
  add_scene_options(*command, options->source);
  command->callback(
      [&action, options, command]
      {
        if (options->to_equilibrium && command->count("--seconds") == 0)
          options->seconds = 10;
        action = [options] { run(*options); };
      });
}

}  // namespace frontalis
