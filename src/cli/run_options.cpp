#include "cli/run_options.hpp"

#include "cli/command_options.hpp"
#include "cli/reactions.hpp"

#include "frontalis/error.hpp"
#include "frontalis/study/step_time.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{

void add_run_options(CLI::App& command, RunOptions& options)
{
  command.add_option("SCENE_OR_MODEL", options.source.path, "scene (YAML) or baked model (.vtkhdf)")->required();
  command.add_option("--activate", options.activation, "activations from 0 to 1: MUSCLE=VALUE,MUSCLE=VALUE,...");
  command.add_option("--expression", options.expression,
                     "a named expression, over which --activate and --bone take precedence");
  command.add_option(
      "--activations", options.activation_file,
      "activations and poses over time: a table (CSV) with a column time [s], one column per muscle, and "
      "BONE.x, .y, .z [mm], .rx, .ry, .rz [degrees]");
  CLI::Option* const demo =
      command.add_flag("--demo", options.demo, "play the scene's demo once, expressions and poses of bones");
  CLI::Option* const to_equilibrium =
      command.add_flag("--to-equilibrium", options.to_equilibrium,
                       "relax to equilibrium under the final activations, within --seconds (10)");
  add_positive(command, "--tolerance", options.tolerance,
               "of equilibrium: remaining motion divided by displacement (0.001)")
      ->needs(to_equilibrium);
  command.add_flag("--ledger", options.solver.ledger, "keep the energy ledger and print it");
  command.add_option("--bone", options.bones,
                     "motion of a bone in the face frame: NAME=X,Y,Z,RX,RY,RZ, shift [mm] and rotation vector about "
                     "the origin [degrees]; once per bone");
  add_ramp(command, options.ramp, "seconds over which activations and bones move linearly (0.1, or half of the run)")
      ->excludes(demo)
      ->excludes(to_equilibrium);
  command.add_option("--without", options.without, "effects to switch off: NAME,NAME,... (see frontalis effects)")
      ->delimiter(',');
  add_positive(command, "--seconds", options.seconds, "simulated seconds (1)");
  command.add_option("--frames", options.frames,
                     "folder for skin_NNNN.ply, landmarks.csv, reactions.csv (of bodies that tissue touches) and "
                     "run.json; files of an earlier run are replaced");
  command.add_flag("--vtp", options.files.vtp,
                   "write the frames also as skin_NNNN.vtp, with displacements, and skin.pvd for ParaView");
  command.add_flag(
      "--vtu", options.files.vtu,
      "write the tissue inside as tissue_NNNN.vtu, with displacements, strains and stresses, and tissue.pvd");
  command.add_option("--plot", options.plot,
                     "FILE.png, and FILE.svg beside it: force on bodies that tissue touches, over time");
  add_movie_options(command, options.movie);
  command.add_flag("--wrinkles", options.wrinkles, "measure the furrows that the skin has at the end but not at rest");
  command
      .add_option(
          "--wrinkles-in", options.wrinkles_in,
          "the same in a part of the skin at rest: LEFT,UP,LEFT,UP, its corners on the subject's lower right and "
          "upper left [mm]")
      ->delimiter(',')
      ->expected(4);
  add_positive(command, "--frame-rate", options.frame_rate, "frames per simulated second (as the model says)")
      ->excludes(to_equilibrium);
  add_solver_options(command, options.solver);
  command
      .add_option(
          "--guard", options.guard_interval,
          "steps between two checks of the motion (512, on a GPU 2048; 0: no checks); an unstable motion goes back "
          "to the last good check and takes shorter steps")
      ->check(CLI::Range(0, 1 << 30));
  command.add_option("--time-step", options.solver.time_step,
                     "longest time step [s], at most the critical one (0: the model's share of the critical one)");
  add_scene_options(command, options.source);
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
  if ((options.files.vtp || options.files.vtu) && options.frames.empty())
    throw WrongUsage("--vtp and --vtu go with --frames, which names the folder");
  plot_path(options.plot);
  if (options.to_equilibrium && options.solver.ledger)
    throw WrongUsage("--ledger: energies do not balance on the way to equilibrium");
  if (const auto& box = options.wrinkles_in; !box.empty() && !(box[0] < box[2] && box[1] < box[3]))
    throw WrongUsage("--wrinkles-in: the first corner must be to the right of the second and below it");
  check_seconds(options.seconds);
  if (options.ramp >= 0 && !options.activation_file.empty() && options.bones.empty())
    throw WrongUsage("--ramp: --activations says when activations and bones move; it goes only with --bone");
  if (!(options.frame_rate >= 0) || !std::isfinite(options.frame_rate))
    throw WrongUsage("--frame-rate: must be a number greater than 0");
  if (options.seconds * std::max(options.frame_rate, 1.0) > 1e6)
    throw WrongUsage("--seconds times --frame-rate: more than a million frames");
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

}  // namespace frontalis
