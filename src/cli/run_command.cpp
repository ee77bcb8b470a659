#include "cli/command_options.hpp"
#include "cli/frame_folder.hpp"
#include "cli/progress.hpp"
#include "cli/reactions.hpp"
#include "cli/run_options.hpp"
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
    const bool whole =
        guard ? guard->advance_checked(seconds, controls, go_on) : solver.advance(seconds, controls, go_on);
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
      folder->add(time, summary.end, summary.rest, summary.bodies, solver);
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
    folder->add(time, summary.end, summary.rest, summary.bodies, solver);
}

// Effects are switched off in reverse order, because an effect comes after the effects that it needs.
void switch_off(Solver& solver, EffectSet off)
{
  const auto effects = every_effect();
  for (auto effect = effects.rbegin(); effect != effects.rend(); ++effect)
    if (off.has(*effect))
      solver.switch_effect(*effect, false);
}

// Throws Error if no skin lies in the part of which wrinkles are asked for.
WrinkleSettings wrinkle_settings(const RunOptions& options, const Model& model)
{
  WrinkleSettings settings;
  for (std::size_t i = 0; i < options.wrinkles_in.size(); ++i)
    (i < 2 ? settings.lower : settings.upper)[1 + i % 2] = 1e-3 * options.wrinkles_in[i];
  const std::vector<std::array<float, 3>> skin = rest_in_face(model).vertices;
  if (!options.wrinkles_in.empty() &&
      std::none_of(skin.begin(), skin.end(), [&](const auto& vertex) { return settings.contains(vertex); }))
    throw Error(
        "--wrinkles-in: no skin lies there; must be two corners LEFT,UP,LEFT,UP in mm from the origin of the face "
        "frame");
  return settings;
}

// Measures wrinkles, unless Ctrl-C ends the run before they are measured.
void measure(const WrinkleSettings& settings, const Model& model, RunSummary& summary)
{
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

// Writes the table of the frames, the movie and the plot.
void write_files(Run& run)
{
  if (run.folder)
    run.folder->finish(json_of(run.model, run.summary));
  std::fflush(stdout);  // what follows needs other programs, which may be missing
  if (run.movie)
    run.movie->finish();
  if (run.plot)
    run.plot->write();
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
  const WrinkleSettings wrinkles = wrinkle_settings(options, *model);
  const std::unique_ptr<Solver> solver = make_solver(model, options.solver);
  switch_off(*solver, off);
  Run run{ options, *model, std::move(curve), *solver, std::nullopt };
  if (!options.plot.empty())
    run.plot.emplace(plot_path(options.plot), *model);
  // They remove frames of earlier runs, which must stay if an option is refused.
  if (!options.movie.path.empty())
    run.movie.emplace(options.movie, options.frame_rate, *model);
  if (!options.frames.empty())
    run.folder.emplace(options.frames, *model, options.files);
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
    if (summary.frames > 0)
      write_files(run);
    throw;
  }
  if (options.wrinkles || !options.wrinkles_in.empty())
    measure(wrinkles, *model, summary);
  print_result(*model, summary);
  write_files(run);
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
  add_run_options(*command, *options);
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
