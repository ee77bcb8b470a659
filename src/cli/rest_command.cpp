#include "cli/command_options.hpp"
#include "cli/model_source.hpp"
#include "cli/posed_face.hpp"
#include "cli/progress.hpp"

#include "frontalis/error.hpp"
#include "frontalis/content_hash.hpp"
#include "frontalis/model/model_file.hpp"
#include "frontalis/runner/named_controls.hpp"
#include "frontalis/solver/rest_shape.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

using Vectors = std::vector<std::array<double, 3>>;

struct RestOptions
{
  ModelSource source;
  std::string file;
  std::vector<std::string> creases;
  double set = 0;
  bool neutral = false;
  double seconds = 0.6;
  SolverSettings solver;
};

// Returns the displacements [m] of the face at rest, in equilibrium with all that acts on it there, such as gravity and
// the tone of muscles.
Vectors resting(const std::shared_ptr<const Model>& model, const RestOptions& options)
{
  const auto solver = make_solver(model, options.solver);
  Progress progress;
  const double seconds = 10 * options.seconds / model->time_scaling;
  const Equilibrium found = solver->settle(rest_controls(*model), 1e-3, seconds,
                                           [&](const Equilibrium& now)
                                           {
                                             progress.update("relaxing", now.seconds / seconds);
                                             return !interrupt_requested();
                                           });
  if (interrupt_requested())
    throw Interrupted();
  if (!found.reached)
    throw Error(fmt::format("{}: the face at rest is not in equilibrium after {:g} s; give more --seconds",
                            options.source.path, 10 * options.seconds));
  Vectors displacements;
  solver->displacements(displacements);
  return displacements;
}

// Returns the displacements [m] in a pose; `lines` receives the heights of fine lines [m].
Vectors posed(PosedFace& face, const Model& model, const std::string& pose, double seconds, std::vector<float>& lines)
{
  Progress progress;
  try
  {
    const auto watch = [&](double done) { progress.update(pose, done); };
    lines = face.take(expression_controls(model, pose), seconds, watch).line_height;
  }
  catch (const Unstable& error)
  {
    throw Error(pose + ": " + error.what());
  }
  Vectors displacements;
  face.solver().displacements(displacements);
  return displacements;
}

void change_rest(const RestOptions& options)
{
  check_model_output(options.file);
  if (options.creases.empty() == (options.set > 0))
    throw WrongUsage("--creases goes with --set, the part of the folds that stays");
  if (options.creases.empty() && !options.neutral)
    throw WrongUsage("nothing to change: give --creases, --neutral or both");
  const auto before = std::make_shared<const Model>(obtain_model(options.source));
  Model model = *before;
  if (!options.creases.empty() && model.shells.empty() && model.film.laws.empty())
    throw Error(options.source.path +
                ": no layer is a shell ('shell: true') and the skin has no fine_lines; creases stay in these alone");
  if (options.neutral)
  {
    const Vectors rest = resting(before, options);
    place_skin_at(model, rest);
    double largest = 0;
    for (const auto& u : rest)
      largest = std::max(largest, std::hypot(u[0], u[1], u[2]));
    fmt::print("neutral  the tissue moves by at most {:.3f} mm to its equilibrium\n", 1e3 * largest);
  }
  if (!options.creases.empty())
  {
    PosedFace face(before, options.solver);
    for (const std::string& pose : options.creases)
    {
      std::vector<float> lines;
      add_creases(model, posed(face, *before, pose, options.seconds, lines), options.set);
      model.film.crease.resize(lines.size(), 0);
      for (std::size_t v = 0; v < lines.size(); ++v)
        model.film.crease[v] += static_cast<float>(options.set) * lines[v];
    }
    fmt::print("creases  {:g} of the folds of {} stay\n", options.set, fmt::join(options.creases, ", "));
  }
  // The model gets a hash of its own, because cached data of the original model, such as its influence
  // (FitSettings::cache), do not hold for it.
  if (!model.scene_hash.empty())
    model.scene_hash = content_hash(fmt::format("{} {} {} {} {}", before->scene_hash, options.neutral, options.set,
                                                fmt::join(options.creases, ","), options.seconds));
  write_model(model, options.file);
  fmt::print("written  {}\n", options.file);
}

}  // namespace

void add_rest_command(CLI::App& app)
{
  const auto options = std::make_shared<RestOptions>();
  CLI::App* command =
      app.add_subcommand("rest", "change a model at rest: creases that stay, a neutral face that is in equilibrium");
  command->add_option("SCENE_OR_MODEL", options->source.path, "scene (YAML) or baked model (.vtkhdf)")->required();
  command->add_option("-o,--output", options->file, "model file to write (.vtkhdf)")->required();
  command
      ->add_option("--creases", options->creases,
                   "expressions whose folds stay in shells and fine lines: NAME,NAME,...")
      ->delimiter(',');
  command
      ->add_option("--set", options->set,
                   "part of the folds that stays in the shape without moment, 0 to 1; a third of it shows")
      ->check(CLI::Range(0., 1.));
  command->add_flag("--neutral", options->neutral,
                    "place the skin so that it is where the scene has it once the tissue is in equilibrium");
  add_positive(*command, "--seconds", options->seconds, "simulated seconds from rest to an expression (0.6)");
  add_solver_options(*command, options->solver);
  add_scene_options(*command, options->source);
  command->callback([options] { change_rest(*options); });
}

}  // namespace frontalis
