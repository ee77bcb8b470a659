#include "cli/command_options.hpp"
#include "cli/given_controls.hpp"
#include "cli/model_source.hpp"
#include "cli/movie.hpp"
#include "cli/progress.hpp"
#include "cli/reactions.hpp"
#include "cli/run_output.hpp"

#include "frontalis/error.hpp"
#include "frontalis/runner/face_frame.hpp"
#include "frontalis/solver/fine_lines.hpp"
#include "frontalis/solver/rigid_motion.hpp"
#include "frontalis/study/step_time.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

namespace frontalis
{
namespace
{

// Time steps between two checks for Ctrl-C: about a second of wall time with a large model.
constexpr double steps_per_slice = 4096;

struct RunOptions
{
  ModelSource source;
  std::string activation, expression, activation_file;
  std::vector<std::string> bones;
  std::vector<std::string> without;
  bool to_equilibrium = false;
  double tolerance = 1e-3;
  double ramp = -1;  ///< duration of the ramp [s]; < 0: 0.1 s, or half of the run if that is less
  bool demo = false;
  double seconds = 1;
  bool seconds_given = false;
  std::string frames, plot;
  MovieOptions movie;
  bool wrinkles = false;
  std::vector<double> wrinkles_in;  ///< smallest left and up, largest left and up [mm]; empty: everywhere
  bool vtp = false;
  double frame_rate = 0;  ///< [1/s]; 0: the model's frame rate
  SolverSettings solver;
  int guard_interval = -1;  ///< steps between checks; 0: no guard; -1: the backend's default
};

/// A solver, the controls that move it, and observations of its motion.
struct Run
{
  const RunOptions& options;
  const Model& model;
  ControlCurve curve;
  Solver& solver;
  std::optional<FrameFolder> folder;
  std::optional<ReactionPlot> plot{};
  std::optional<Movie> movie{};
  std::optional<Guard> guard{};
  std::unique_ptr<FineLines> fine_lines{};
  RunSummary summary{};
  double time = 0;  ///< simulated time so far, on the clock of the activations [s]

  void play();
  void settle();

private:
  void observe();
  void advance_to(double end);
  void advance(double end);
};

// Observes the present state, and ends the run before a frame of a diverged motion is written.
void Run::observe()
{
  solver.skin(summary.end);
  summary.monitor = solver.monitor();
  if (summary.ledger)
    summary.ledger = solver.ledger();
  if (fine_lines)
  {
    options.to_equilibrium ? fine_lines->add_settled(summary.end) : fine_lines->add_to(summary.end, true);
    summary.fine_lines += fine_lines->seconds();
  }
  if (!summary.monitor.finite || !is_finite(summary.end))
    throw Error(
        fmt::format("the motion diverged at {:g} s: displacements are no longer finite; use a smaller "
                    "time_step_share, smaller activations or more damping",
                    time));
  summary.bodies = bodies_in_face_frame(solver, model);
  to_face_frame(model, summary.end);
  summary.seconds = time;
  summary.time_step = solver.time_step();
  summary.profile = solver.profile();
  summary.peak_kinetic = std::max(summary.peak_kinetic, summary.monitor.kinetic);
  summary.peak_internal = std::max(summary.peak_internal, summary.monitor.internal);
  summary.worst_jacobian = std::min(summary.worst_jacobian, summary.monitor.worst_jacobian);
}

// Advances to a time. Activations and bones move linearly between the knots of the curve.
void Run::advance_to(double end)
{
  for (const double knot : curve.time)
    if (time < knot && knot < end)
      advance(knot);
  advance(end);
}

void Run::advance(double end)
{
  while (time < end && !interrupt_requested())
  {
    const double next = std::min(end, time + steps_per_slice * solver.time_step() * model.time_scaling);
    const Controls controls = curve.at(next);
    const double seconds = (next - time) / model.time_scaling;
    const auto go_on = [] { return !interrupt_requested(); };
    const bool whole = guard ? guard->advance(seconds, controls, go_on) : solver.advance(seconds, controls, go_on);
    time = whole ? next : solver.time() * model.time_scaling;
  }
}

// Plays the motion frame by frame. Ctrl-C ends it early.
void Run::play()
{
  const auto frames = static_cast<int>(std::max(1.0, std::ceil(options.seconds * options.frame_rate * (1 - 1e-9))));
  const double begin = wall_seconds();
  Progress progress;
  for (int frame = 0; frame <= frames && summary.complete; ++frame)
  {
    advance_to(frame == frames ? options.seconds : frame / options.frame_rate);
    observe();
    if (guard)
      summary.guard = guard->counts();
    if (frame == 0)
      summary.rest = summary.end;
    if (folder)
      folder->add(time, summary.end, summary.rest, summary.bodies);
    if (plot)
      plot->add(time, summary.bodies);
    if (movie)
      movie->add(summary.end, solver.controls());
    summary.frames = frame + 1;
    summary.wall = wall_seconds() - begin;
    progress.update("running", static_cast<double>(frame) / frames);
    summary.complete = time >= options.seconds || !interrupt_requested();
  }
}

// Relaxes the tissue to equilibrium under the final activations.
void Run::settle()
{
  const double begin = wall_seconds();
  observe();
  summary.rest = summary.end;
  Progress progress;
  const double seconds = options.seconds / model.time_scaling;
  const auto go_on = [&](const Equilibrium& now)
  {
    progress.update("relaxing", now.seconds / seconds);
    return !interrupt_requested();
  };
  const Controls& target = curve.controls.back();
  const Equilibrium found = guard ? guard->settle(target, options.tolerance, seconds, go_on)
                                  : solver.settle(target, options.tolerance, seconds, go_on);
  time = found.seconds * model.time_scaling;
  observe();
  summary.frames = 1;
  summary.wall = wall_seconds() - begin;
  summary.equilibrium = found;
  summary.complete = !interrupt_requested() || found.reached;
  if (folder)
    folder->add(time, summary.end, summary.rest, summary.bodies);
}

void check_options(const RunOptions& options)
{
  if (!options.activation_file.empty() && (!options.activation.empty() || !options.expression.empty()))
    throw WrongUsage("--activations goes with neither --activate nor --expression");
  if (options.demo && (!options.activation.empty() || !options.expression.empty() || !options.activation_file.empty() ||
                       !options.bones.empty() || options.to_equilibrium))
    throw WrongUsage("--demo goes with none of --activate, --expression, --activations, --bone, --to-equilibrium");
  if ((!options.plot.empty() || !options.movie.path.empty()) && options.to_equilibrium)
    throw WrongUsage("--plot and --movie: there is no time on the way to equilibrium");
  if (options.vtp && options.frames.empty())
    throw WrongUsage("--vtp goes with --frames, which names the folder");
  plot_path(options.plot);
  if (options.to_equilibrium && options.solver.ledger)
    throw WrongUsage("--ledger: energies do not balance on the way to equilibrium");
  if (const auto& box = options.wrinkles_in; !box.empty() && !(box[0] < box[2] && box[1] < box[3]))
    throw WrongUsage("--wrinkles-in: the first corner must be to the right of the second and below it");
  check_seconds(options.seconds);
  if (!std::isfinite(options.ramp))
    throw WrongUsage("--ramp: must be a number from 0");
  if (!(options.frame_rate >= 0) || !std::isfinite(options.frame_rate))
    throw WrongUsage("--frame-rate: must be a number greater than 0");
  if (options.seconds * std::max(options.frame_rate, 1.0) > 1e6)
    throw WrongUsage("--seconds times --frame-rate: more than a million frames");
}

// Effects are switched off in reverse order, because an effect comes after the effects that it needs.
void switch_off(Solver& solver, EffectSet off)
{
  const auto effects = every_effect();
  for (auto effect = effects.rbegin(); effect != effects.rend(); ++effect)
    if (off.has(*effect))
      solver.switch_effect(*effect, false);
}

ControlCurve curve_of(const RunOptions& options, const Model& model)
{
  const double ramp = options.ramp < 0 ? std::min(0.1, options.seconds / 2) : options.ramp;
  if (options.activation_file.empty())
  {
    Controls target = target_controls(model, options.expression, parse_activation_list(options.activation));
    parse_bone_motions(model, options.bones, target.bone);
    return ramp_to(target, ramp);
  }
  std::vector<RigidTransform> bones(model.bones.size());
  parse_bone_motions(model, options.bones, bones);
  const ControlCurve curve = read_control_curve(options.activation_file, model);
  return options.bones.empty() ? curve : with_bones(curve, bones, ramp);
}

// Returns the demo of the model. Unless --seconds was given, sets it to the demo's duration.
ControlCurve demo_of(RunOptions& options, const Model& model)
{
  if (model.demo.empty())
    throw Error(options.source.path + ": has no demo; --demo needs one");
  const Controls rest{ std::vector<float>(model.muscles.size(), 0), std::vector<RigidTransform>(model.bones.size()) };
  ControlCurve curve = demo_curve(model, rest);
  if (!options.seconds_given)
    options.seconds = curve.time.back();
  return curve;
}

// Measures wrinkles, unless Ctrl-C ends the run before they are measured.
void measure(const RunOptions& options, const Model& model, RunSummary& summary)
{
  WrinkleSettings settings;
  for (std::size_t i = 0; i < options.wrinkles_in.size(); ++i)
    (i < 2 ? settings.lower : settings.upper)[1 + i % 2] = 1e-3 * options.wrinkles_in[i];
  Progress progress;
  const auto go_on = [&](double done)
  {
    if (interrupt_requested())
      throw Interrupted();
    progress.update("wrinkles", done);
  };
  try
  {
    const WrinkleMeter meter(rest_in_face(model), model.skin.triangles, settings, go_on);
    summary.wrinkles = meter.measure(summary.end, go_on);
  }
  catch (const Interrupted&)
  {
    summary.complete = false;
  }
}

void simulate(RunOptions& options)
{
  check_options(options);
  parse_activation_list(options.activation);
  EffectSet off;
  for (const std::string& name : options.without)
    off = off.with(effect_from_name(name));

  const auto model = std::make_shared<const Model>(obtain_model(options.source));
  if (options.frame_rate <= 0)
    options.frame_rate = model->frame_rate;
  ControlCurve curve = options.demo ? demo_of(options, *model) : curve_of(options, *model);
  const std::unique_ptr<Solver> solver = make_solver(model, options.solver);
  switch_off(*solver, off);
  Run run{ options, *model, std::move(curve), *solver, std::nullopt };
  if (!options.plot.empty())
    run.plot.emplace(plot_path(options.plot), *model);
  // They remove frames of earlier runs, which must stay if an option is refused.
  if (!options.movie.path.empty())
    run.movie.emplace(options.movie, options.frame_rate, *model);
  if (!options.frames.empty())
    run.folder.emplace(options.frames, *model, options.vtp);
  run.fine_lines = FineLines::make(model, false);
  RunSummary& summary = run.summary;
  if (options.solver.ledger)
    summary.ledger.emplace();
  summary.backend = solver->description();
  summary.time_step = solver->time_step();
  print_set_up(*model, summary);

  if (options.guard_interval != 0)
  {
    GuardSettings watch;
    watch.interval = std::max(options.guard_interval, 0);
    watch.ledger = options.solver.ledger;
    run.guard.emplace(*solver, model, watch);
  }
  try
  {
    options.to_equilibrium ? run.settle() : run.play();
  }
  catch (const Error& error)
  {
    // The result so far is written before the error is reported.
    summary.complete = false;
    summary.failure = error.what();
    if (run.folder && summary.frames > 0)
      run.folder->finish(json_of(*model, summary));
    throw;
  }
  if (options.wrinkles || !options.wrinkles_in.empty())
    measure(options, *model, summary);
  if (run.folder)
    run.folder->finish(json_of(*model, summary));
  print_result(*model, summary);
  std::fflush(stdout);  // what follows needs other programs, which may be missing
  if (run.movie)
    run.movie->finish();
  if (run.plot)
    run.plot->write();
  if (!summary.complete)
    throw Interrupted();
  if (summary.equilibrium && !summary.equilibrium->reached)
    throw Error(
        fmt::format("no equilibrium after {:g} s of relaxation: {:.3g} of the displacement is left; allow more "
                    "--seconds or a larger --tolerance",
                    options.seconds, summary.equilibrium->residual));
}

}  // namespace

void add_run_command(CLI::App& app)
{
  CLI::App* command = app.add_subcommand("run", "simulate a scene or a baked model and print how its landmarks moved");
  const auto options = std::make_shared<RunOptions>();
  command->add_option("SCENE_OR_MODEL", options->source.path, "scene (YAML) or baked model (.vtkhdf)")->required();
  command->add_option("--activate", options->activation, "activations from 0 to 1: MUSCLE=VALUE,MUSCLE=VALUE,...");
  command->add_option("--expression", options->expression,
                      "a named expression, over which --activate and --bone take precedence");
  command->add_option(
      "--activations", options->activation_file,
      "activations and poses over time: a table (CSV) with a column time [s], one column per muscle, and "
      "BONE.x, .y, .z [mm], .rx, .ry, .rz [degrees]");
  command->add_flag("--demo", options->demo, "play the scene's demo once, expressions and poses of bones");
  command->add_flag("--to-equilibrium", options->to_equilibrium,
                    "relax to equilibrium under the final activations, within --seconds (10)");
  add_positive(*command, "--tolerance", options->tolerance,
               "of equilibrium: remaining motion divided by displacement (0.001)");
  command->add_flag("--ledger", options->solver.ledger, "keep the energy ledger and print it");
  command->add_option("--bone", options->bones,
                      "motion of a bone in the face frame: NAME=X,Y,Z,RX,RY,RZ, shift [mm] and rotation vector about "
                      "the origin [degrees]; once per bone");
  command
      ->add_option("--ramp", options->ramp,
                   "seconds over which activations and bones move linearly (0.1, or half of the run)")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--without", options->without, "effects to switch off: NAME,NAME,... (see frontalis effects)")
      ->delimiter(',');
  add_positive(*command, "--seconds", options->seconds, "simulated seconds (1)");
  command->add_option("--frames", options->frames,
                      "folder for skin_NNNN.ply, landmarks.csv, reactions.csv (of bodies that tissue touches) and "
                      "run.json; files of an earlier run are replaced");
  command->add_flag("--vtp", options->vtp,
                    "write the frames also as skin_NNNN.vtp, with displacements, and skin.pvd for ParaView");
  command->add_option("--plot", options->plot,
                      "FILE.png, and FILE.svg beside it: force on bodies that tissue touches, over time");
  add_movie_options(*command, options->movie);
  command->add_flag("--wrinkles", options->wrinkles,
                    "measure the furrows that the skin has at the end but not at rest");
  command
      ->add_option(
          "--wrinkles-in", options->wrinkles_in,
          "the same in a part of the skin at rest: LEFT,UP,LEFT,UP, its corners on the subject's lower right and "
          "upper left [mm]")
      ->delimiter(',')
      ->expected(4);
  add_positive(*command, "--frame-rate", options->frame_rate, "frames per simulated second (as the model says)");
  add_solver_options(*command, options->solver);
  command
      ->add_option(
          "--guard", options->guard_interval,
          "steps between two checks of the motion (512, on a GPU 2048; 0: no checks); an unstable motion goes back "
          "to the last good check and takes shorter steps")
      ->check(CLI::Range(0, 1 << 30));
  command->add_option("--time-step", options->solver.time_step,
                      "longest time step [s], at most the critical one (0: the model's share of the critical one)");
  add_scene_options(*command, options->source);
  command->callback(
      [options, command]
      {
        options->seconds_given = command->count("--seconds") > 0;
        if (options->to_equilibrium && !options->seconds_given)
          options->seconds = 10;
        simulate(*options);
      });
}

}  // namespace frontalis
