#include "command.hpp"
#include "model_source.hpp"

#include "frontalis/error.hpp"

#include <CLI/CLI.hpp>

#include <memory>

#ifdef FRONTALIS_WITH_BAKE
#include "interrupt.hpp"
#include "progress.hpp"

#include "frontalis/bake/bake.hpp"
#include "frontalis/runner/named_controls.hpp"
#include "frontalis/scene/read_scene.hpp"
#include "frontalis/study/accuracy.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#endif

namespace frontalis
{
namespace
{

struct AccuracyOptions
{
  ModelSource source;
  std::vector<std::string> knobs;
  std::vector<double> voxels;
  std::string expression;
  double ramp = 0, hold = 0;
  double budget = 0;
  double tolerance = 0, time = 0;
  std::string folder, save;
  std::string backend = "auto";
  int threads = 0;
  bool quick = false;
};

#ifdef FRONTALIS_WITH_BAKE

Scene scene_with(Scene scene, const AccuracySetting& setting)
{
  scene.accuracy = setting.profile;
  // what decides nothing, so that equal variants are known as such
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

Model bake_interruptibly(const Scene& scene)
{
  try
  {
    return bake(scene, nullptr, [](const std::string&, double) { return !interrupt_requested(); });
  }
  catch (const Error&)
  {
    // an interrupted bake ends in an error that is none
    if (interrupt_requested())
      throw Interrupted();
    throw;
  }
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

AccuracyPlan plan_of(const Scene& scene, const AccuracyOptions& options)
{
  AccuracyPlan plan;
  plan.standard.profile = standard_profile(scene, !options.source.accuracy.empty());
  plan.standard.backend = backend_from_name(options.backend);
  if (plan.standard.backend == Backend::automatic)
  {
    const auto backends = available_backends();
    const bool device = std::find(backends.begin(), backends.end(), Backend::cuda) != backends.end();
    plan.standard.backend = device ? Backend::cuda : Backend::cpu;
  }
  plan.profiles = scene.profiles;
  plan.knobs = options.knobs;
  plan.quick = options.quick;
  plan.budget = options.budget > 0 ? options.budget : options.quick ? 280 : 0;
  plan.threads = options.threads;
  plan.folder = options.folder;
  plan.frame_rate = scene.time.frame_rate;
  plan.history.ramp = options.ramp > 0 ? options.ramp : options.quick ? 0.2 : 0.3;
  plan.history.hold = options.hold > 0 ? options.hold : options.quick ? 0.1 : 0.3;
  const double edge = plan.standard.profile.voxel[0];
  if (options.voxels.empty())
    for (const double factor :
         options.quick ? std::vector<double>{ 2, 1.5, 1, 0.75, 0.5 } : std::vector<double>{ 1.5, 1, 0.75, 0.5, 0.375 })
      plan.edges.push_back(factor * edge);
  else
    for (const double millimetres : options.voxels)
      plan.edges.push_back(1e-3 * millimetres);
  return plan;
}

std::string time_text(double seconds)
{
  char text[32];
  std::snprintf(text, sizeof text, seconds < 90 ? "%.0f s" : "%.0f min", seconds < 90 ? seconds : seconds / 60);
  return text;
}

void write_outputs(const AccuracyFindings& findings, const AccuracyOptions& options, const std::string& title)
{
  const std::string path = options.folder + "/accuracy";
  const Table table = accuracy_table(findings);
  const std::string report = accuracy_report(findings, title);
  write_text(path + ".csv", table.csv());
  write_text(path + ".json", table.json());
  write_text(path + ".md", report + "\n![" + title + "](accuracy.png)\n");
  std::printf("\n%s", table.text().c_str());
  std::printf("\nreference %s\n",
              report.substr(report.find("\n\n") + 2, report.find("\n\n|") - report.find("\n\n") - 2).c_str());
  std::printf("\nwritten   %s.csv, .json, .md", path.c_str());
  try
  {
    write_plot(accuracy_plot(findings, title), path);
    std::printf(", .png, .svg\n");
  }
  catch (const Error& error)
  {
    std::printf("\nno plot   %s\n", error.what());
  }
}

void choose(const AccuracyFindings& findings, const AccuracyOptions& options)
{
  if (options.tolerance <= 0 && options.time <= 0)
    return;
  const AccuracyRow& row = options.tolerance > 0 ? cheapest_within(findings, 1e-3 * options.tolerance)
                                                 : most_accurate_within(findings, options.time);
  const std::string profile = profile_text(row, "chosen", findings.machine);
  std::printf("chosen    %s: error %.3g mm RMS, %.3g mm at most; %.3g s a simulated second%s\n\n  %s\n",
              row.name.c_str(), 1e3 * row.error.rms, 1e3 * row.error.largest, row.cost,
              row.noisy() ? " (timed on a disturbed machine)" : "", profile.c_str());
  if (!options.save.empty())
  {
    write_text(options.save,
               "# " + row.name + ", as measured by: frontalis accuracy " + options.source.path + "\n" + profile + "\n");
    std::printf("\nwritten   %s; use it with --accuracy %s\n", options.save.c_str(), options.save.c_str());
  }
}

void study(AccuracyOptions options)
{
  check_numbers(options);
  if (is_model_file(options.source.path) && std::filesystem::exists(options.source.path))
    throw Error(options.source.path + ": is a baked model; a study of accuracy needs the scene (YAML)");
  if (options.tolerance > 0 && options.time > 0)
    throw WrongUsage("--tolerance and --time: one of the two");
  if (!options.save.empty() && options.tolerance <= 0 && options.time <= 0)
    throw WrongUsage("--save goes with --tolerance or --time");
  SceneOptions scene_options;
  scene_options.mesh_directory = options.source.mesh_directory;
  scene_options.accuracy = options.source.accuracy;
  scene_options.voxel_quantity = options.source.voxel;
  const Scene scene = read_scene(options.source.path, scene_options);
  const std::string name = std::filesystem::path(options.source.path).stem().string();
  if (options.folder.empty())
    options.folder = "accuracy_" + name;
  AccuracyPlan plan = plan_of(scene, options);

  // meshes are read once for the content of all
  Scene bare = scene_with(scene, {});
  const std::string meshes = bare.content;
  bare.surfaces.clear();
  const ModelMaker maker{ [&](const AccuracySetting& setting) { return meshes + scene_with(bare, setting).content; },
                          [&](const AccuracySetting& setting)
                          { return bake_interruptibly(scene_with(scene, setting)); } };
  // the coarsest model knows the muscles' names
  AccuracySetting coarsest = plan.standard;
  coarsest.profile.voxel.fill(plan.edges.front());
  plan.history.activation = activation_of(maker.bake(coarsest), options);

  Progress progress;
  int count = 0;
  std::string last;
  double left_then = 0;
  const AccuracyFindings findings = study_accuracy(
      plan, maker,
      [&](const std::string& stage, double done, double left)
      {
        if (stage != last || done == 0)
        {
          ++count;
          left_then = left;
        }
        last = stage;
        progress.update(
            std::to_string(count) + ": " + stage + (left_then > 0 ? ", then about " + time_text(left_then) : ""), done);
        return !interrupt_requested();
      });
  progress.clear();
  if (!findings.complete)
  {
    std::fprintf(stderr, "what was finished is kept in %s; the same command goes on from there\n",
                 options.folder.c_str());
    throw Interrupted();
  }
  write_outputs(findings, options, "Accuracy against time: " + name);
  choose(findings, options);
}

#else

void study(const AccuracyOptions& options)
{
  throw Error(options.source.path +
              ": a study of accuracy bakes its models, and this program was built without baking");
}

#endif

}  // namespace

void add_accuracy_command(CLI::App& app, Action& action)
{
  auto options = std::make_shared<AccuracyOptions>();
  CLI::App* command = app.add_subcommand(
      "accuracy", "measure what each setting of a scene costs and how accurate it is, and choose one");
  command->add_option("SCENE", options->source.path, "scene file (YAML)")->required();
  add_scene_options(*command, options->source);
  command
      ->add_option(
          "--knobs", options->knobs,
          "only these, without combinations: voxel, samples, fill_min, hourglass, integration, precision, share, "
          "time_step, mass_scaling, poisson, time_scaling, backend, profiles")
      ->delimiter(',');
  command->add_option("--voxels", options->voxels, "voxel edges, coarse to fine [mm]; the last is the reference's")
      ->delimiter(',')
      ->check(CLI::PositiveNumber);
  command->add_flag("--quick", options->quick, "fewer settings, a shorter motion: minutes");
  command
      ->add_option("--budget", options->budget,
                   "wall seconds that the study may take (280 with --quick, else all it needs)")
      ->check(CLI::PositiveNumber);
  command->add_option("--expression", options->expression, "what is activated (the scene's first expression)");
  command->add_option("--ramp", options->ramp, "seconds over which activations grow (0.3)")->check(CLI::PositiveNumber);
  command->add_option("--hold", options->hold, "seconds for which they are held (0.3)")->check(CLI::PositiveNumber);
  auto* tolerance = command->add_option("--tolerance", options->tolerance,
                                        "choose the cheapest setting with at most this error of the skin, RMS [mm]");
  tolerance->check(CLI::PositiveNumber);
  command
      ->add_option("--time", options->time,
                   "choose the most accurate setting of at most so many wall seconds a "
                   "simulated second")
      ->check(CLI::PositiveNumber);
  command->add_option("--save", options->save, "write the chosen profile to this file, for --accuracy");
  command->add_option("-o,--output", options->folder, "folder for results and finished variants (accuracy_SCENE)");
  command->add_option("--backend", options->backend, "auto, reference, cpu or cuda (auto)")
      ->check(CLI::IsMember({ "auto", "reference", "cpu", "cuda" }));
  command->add_option("--threads", options->threads, "CPU threads (0: one a core)")->check(CLI::Range(0, 1024));
  command->callback([options, &action] { action = [options] { study(*options); }; });
}

}  // namespace frontalis
