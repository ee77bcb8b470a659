#ifdef FRONTALIS_WITH_BAKE
// the subject of a study of accuracy, as the command line names it

#include "cli/accuracy_subject.hpp"
#include "cli/command.hpp"

#include "frontalis/error.hpp"
#include "frontalis/runner/named_controls.hpp"
#include "frontalis/scene/read_scene.hpp"
#include "frontalis/study/accuracy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace frontalis
{
namespace
{

Scene scene_with(Scene scene, const AccuracySetting& setting)
{
  scene.accuracy = setting.profile;
  // names and measured figures do not change the model, and must not make equal variants look different
  scene.accuracy.name = "standard";
  scene.accuracy.measured = {};
  scene.profiles.clear();
  scene.time.scaling *= setting.time_scaling;
  if (setting.poisson != 0)
    for (SceneMaterial& material : scene.materials)
      material.parameters["poisson"] = setting.poisson;
  scene.content = content_of(scene);
  return scene;
}

// the profile called standard, else the one that the scene takes
AccuracyProfile standard_profile(const Scene& scene, bool chosen)
{
  if (!chosen)
    for (const AccuracyProfile& profile : scene.profiles)
      if (profile.name == "standard")
        return profile;
  return scene.accuracy;
}

// an expression's activations; without expressions all muscles at 0.75
std::vector<float> activation_of(const Model& model, const AccuracyOptions& options)
{
  if (!options.expression.empty())
    return expression_activation(model, options.expression);
  if (!model.expressions.empty())
    return expression_activation(model, model.expressions.front().name);
  return std::vector<float>(model.muscles.size(), 0.75F);
}

void check_numbers(const AccuracyOptions& options)
{
  std::vector<double> numbers = options.voxels;
  numbers.insert(numbers.end(), { options.budget, options.ramp, options.hold, options.tolerance, options.time });
  for (const double number : numbers)
    if (!(number >= 0) || !std::isfinite(number))
      throw WrongUsage("--voxels, --budget, --ramp, --hold, --tolerance, --time: must be numbers greater than 0");
}

// takes over the options that any subject has; those that were not given change nothing
void take_options(const AccuracyOptions& options, AccuracyPlan& plan)
{
  plan.standard.backend = backend_from_name(options.solver.backend);
  if (plan.standard.backend == "auto")
  {
    const auto backends = available_backends();
    const bool device = std::find(backends.begin(), backends.end(), "cuda") != backends.end();
    plan.standard.backend = device ? "cuda" : "cpu";
  }
  if (!options.knobs.empty())
    plan.knobs = options.knobs;
  plan.quick = options.quick;
  plan.budget = options.budget > 0 ? options.budget : options.quick ? 280 : 0;
  plan.threads = options.solver.threads;
  if (options.ramp > 0)
    plan.history.ramp = options.ramp;
  if (options.hold > 0)
    plan.history.hold = options.hold;
  if (!options.voxels.empty())
    plan.edges.clear();
  for (const double millimetres : options.voxels)
    plan.edges.push_back(1e-3 * millimetres);
}

AccuracySubject scene_subject(const AccuracyOptions& options)
{
  SceneOptions scene_options;
  scene_options.mesh_directory = options.source.mesh_directory;
  scene_options.accuracy = options.source.accuracy;
  scene_options.voxel_quantity = options.source.voxel;
  const Scene scene = read_scene(options.source.path, scene_options);
  AccuracySubject subject{ std::filesystem::path(options.source.path).stem().string(), {}, {} };
  AccuracyPlan& plan = subject.plan;
  plan.standard.profile = standard_profile(scene, !options.source.accuracy.empty());
  plan.profiles = scene.profiles;
  plan.frame_rate = scene.time.frame_rate;
  plan.history = { {}, options.quick ? 0.2 : 0.3, options.quick ? 0.1 : 0.3 };
  for (const double factor :
       options.quick ? std::vector<double>{ 2, 1.5, 1, 0.75, 0.5 } : std::vector<double>{ 1.5, 1, 0.75, 0.5, 0.375 })
    plan.edges.push_back(factor * plan.standard.profile.voxel[0]);
  take_options(options, plan);

  // the meshes' content is the same for all settings and is hashed once
  Scene bare = scene_with(scene, {});
  const std::string meshes = bare.content;
  bare.surfaces.clear();
  subject.maker = { [meshes, bare](const AccuracySetting& setting)
                    { return meshes + scene_with(bare, setting).content; },
                    [scene](const AccuracySetting& setting) {
                      return bake_interruptibly(scene_with(scene, setting), nullptr, [](const std::string&, double) {});
                    } };
  // any model has the names of the muscles; the coarsest is baked fastest
  AccuracySetting coarsest = plan.standard;
  coarsest.profile.voxel.fill(plan.edges.front());
  plan.history.activation = activation_of(subject.maker.bake(coarsest), options);
  return subject;
}

AccuracySubject closed_form_subject(const ClosedForm& form, const AccuracyOptions& options)
{
  const ModelSource& source = options.source;
  if (!source.accuracy.empty() || !source.voxel.empty() || !source.mesh_directory.empty() ||
      !options.expression.empty() || options.ramp > 0 || options.hold > 0)
    throw WrongUsage(form.name +
                     " is a body with a closed form; --accuracy, --voxel, --mesh-dir, --expression, --ramp "
                     "and --hold go with scenes");
  for (const std::string& knob : options.knobs)
    if (std::find(form.plan.knobs.begin(), form.plan.knobs.end(), knob) == form.plan.knobs.end())
      throw Error(
          fmt::format("{} has no knob '{}'; its knobs are {}", form.name, knob, fmt::join(form.plan.knobs, ", ")));
  AccuracySubject subject{ form.name, form.plan, form.maker };
  take_options(options, subject.plan);
  return subject;
}

}  // namespace

AccuracySubject accuracy_subject(AccuracyOptions& options)
{
  check_numbers(options);
  const std::string& path = options.source.path;
  const bool exists = std::filesystem::exists(path) && !std::filesystem::is_directory(path);
  if (exists && is_model_file(path))
    throw Error(path + ": is a baked model; a study of accuracy needs the scene (YAML)");
  const std::vector<ClosedForm> forms = closed_forms();
  const auto form = std::find_if(forms.begin(), forms.end(), [&](const auto& f) { return f.name == path; });
  if (!exists && form == forms.end())
  {
    std::vector<std::string> names;
    names.reserve(forms.size());
    for (const ClosedForm& known : forms)
      names.push_back(known.name);
    throw Error(fmt::format("{}: there is no such scene file, nor a body of that name with a closed form: {}", path,
                            fmt::join(names, ", ")));
  }
  AccuracySubject subject =
      exists || form == forms.end() ? scene_subject(options) : closed_form_subject(*form, options);
  if (options.folder.empty())
    options.folder = "accuracy_" + subject.name;
  subject.plan.folder = options.folder;
  return subject;
}

}  // namespace frontalis

#endif
