#include "cli/command_options.hpp"
#include "cli/model_source.hpp"

#include "frontalis/error.hpp"

#include <fmt/format.h>

#include <memory>

#ifdef FRONTALIS_WITH_BAKE
#include "cli/progress.hpp"

#include "frontalis/runner/named_controls.hpp"
#include "frontalis/study/accuracy.hpp"

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
  SolverSettings solver;
  bool quick = false;
};

#ifdef FRONTALIS_WITH_BAKE

Scene scene_with(Scene scene, const AccuracySetting& setting)
{
  scene.accuracy = setting.profile;
  // Names and measured figures do not change the model. They are removed, because equal variants must have equal
  // content.
  scene.accuracy.name = "standard";
  scene.accuracy.measured = {};
  scene.profiles.clear();
  scene.time.scaling *= setting.time_scaling;
  scene.content = content_of(scene);
  return scene;
}

// The profile named `standard`, unless the user chose a profile; otherwise the scene's selected profile. --voxel
// replaces its voxel edge.
AccuracyProfile standard_profile(const Scene& scene, const SceneOptions& options)
{
  AccuracyProfile standard = scene.accuracy;
  if (options.accuracy.empty())
    for (const AccuracyProfile& profile : scene.profiles)
      if (profile.name == "standard")
        standard = profile;
  if (!options.voxel_quantity.empty())
    standard.voxel = scene.accuracy.voxel;
  return standard;
}

// The chosen expression, or else the model's first expression; empty if the model has none.
std::string expression_of(const Model& model, const AccuracyOptions& options)
{
  return options.expression.empty() && !model.expressions.empty() ? model.expressions.front().name : options.expression;
}

Controls controls_of(const Model& model, const std::string& expression)
{
  if (!expression.empty())
    return expression_controls(model, expression);
  Controls controls = rest_controls(model);
  std::fill(controls.activation.begin(), controls.activation.end(), 0.75F);
  return controls;
}

void check_numbers(const AccuracyOptions& options)
{
  std::vector<double> numbers = options.voxels;
  numbers.insert(numbers.end(), { options.budget, options.ramp, options.hold, options.tolerance, options.time });
  for (const double number : numbers)
    if (!(number >= 0) || !std::isfinite(number))
      throw WrongUsage("--voxels, --budget, --ramp, --hold, --tolerance, --time: must be numbers greater than 0");
}

// Copies the options that apply to any subject. Options that were not given change nothing.
void take_options(const AccuracyOptions& options, AccuracyPlan& plan)
{
  plan.standard.backend = options.solver.backend;
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

ClosedForm scene_subject(const AccuracyOptions& options)
{
  const Scene scene = read_scene(options.source.path, options.source.scene);
  ClosedForm subject{ std::filesystem::path(options.source.path).stem().string(), {}, {} };
  AccuracyPlan& plan = subject.plan;
  plan.standard.profile = standard_profile(scene, options.source.scene);
  plan.profiles = scene.profiles;
  plan.frame_rate = scene.time.frame_rate;
  plan.history = { {}, {}, options.quick ? 0.2 : 0.3, options.quick ? 0.1 : 0.3 };
  for (const double factor :
       options.quick ? std::vector<double>{ 2, 1.5, 1, 0.75, 0.5 } : std::vector<double>{ 1.5, 1, 0.75, 0.5, 0.375 })
    plan.edges.push_back(factor * plan.standard.profile.voxel[0]);
  take_options(options, plan);
  plan.check();  // before the first bake

  // The meshes are hashed once, because they are the same for all settings.
  Scene bare = scene_with(scene, {});
  const std::string meshes = bare.content;
  bare.surfaces.clear();
  subject.maker = { [meshes, bare](const AccuracySetting& setting)
                    { return meshes + scene_with(bare, setting).content; },
                    [scene](const AccuracySetting& setting) {
                      return bake_interruptibly(scene_with(scene, setting), nullptr, [](const std::string&, double) {});
                    } };
  // All models have the same muscles and bones. Their names come from the coarsest model, which is baked fastest.
  AccuracySetting coarsest = plan.standard;
  coarsest.profile.voxel.fill(plan.edges.front());
  const Model model = subject.maker.bake(coarsest);
  const std::string expression = expression_of(model, options);
  const Controls controls = controls_of(model, expression);
  plan.history.activation = controls.activation;
  plan.subject =
      fmt::format("The motion is {}, reached in {:g} s and held for {:g} s. The setting 'standard' is profile '{}'.",
                  expression.empty() ? "that of all muscles at 0.75, since the scene has no expressions"
                                     : "expression '" + expression + "'",
                  plan.history.ramp, plan.history.hold, plan.standard.profile.name);
  if (std::any_of(controls.bone.begin(), controls.bone.end(),
                  [](const auto& bone) { return !(bone == RigidTransform()); }))
    plan.history.bone = controls.bone;
  return subject;
}

ClosedForm closed_form_subject(ClosedForm form, const AccuracyOptions& options)
{
  const SceneOptions& of_scene = options.source.scene;
  if (!of_scene.accuracy.empty() || !of_scene.voxel_quantity.empty() || !of_scene.mesh_directory.empty() ||
      !options.expression.empty() || options.ramp > 0 || options.hold > 0)
    throw WrongUsage(form.name +
                     " is a body with a closed form; --accuracy, --voxel, --mesh-dir, --expression, --ramp "
                     "and --hold go with scenes");
  for (const std::string& knob : options.knobs)
    if (std::find(form.plan.knobs.begin(), form.plan.knobs.end(), knob) == form.plan.knobs.end())
      throw Error(
          fmt::format("{} has no knob '{}'; its knobs are {}", form.name, knob, fmt::join(form.plan.knobs, ", ")));
  take_options(options, form.plan);
  return form;
}

// The subject on the command line: a scene, or a body with a closed-form solution.
ClosedForm accuracy_subject(const AccuracyOptions& options)
{
  check_numbers(options);
  const std::string& path = options.source.path;
  const bool exists = std::filesystem::exists(path) && !std::filesystem::is_directory(path);
  if (exists && is_model_file(path))
    throw Error(path + ": is a baked model; a study of accuracy needs the scene (YAML)");
  std::string names;
  if (!exists)
    for (const ClosedForm& form : closed_forms())
    {
      if (form.name == path)
        return closed_form_subject(form, options);
      names += (names.empty() ? "" : ", ") + form.name;
    }
  if (!exists)
    throw Error(path + ": there is no such scene file, nor a body of that name with a closed form: " + names);
  return scene_subject(options);
}

std::string time_text(double seconds)
{
  return seconds < 90 ? fmt::format("{:.0f} s", seconds) : fmt::format("{:.0f} min", seconds / 60);
}

void write_outputs(const AccuracyFindings& findings, const AccuracyOptions& options, const std::string& title)
{
  const std::string path = options.folder + "/accuracy";
  const Table table = accuracy_table(findings);
  const std::string report = accuracy_report(findings, title);
  write_text(path + ".csv", table.csv());
  write_text(path + ".json", table.json());
  write_text(path + ".md", report + "\n![" + title + "](accuracy.png)\n");
  // Only the paragraphs of the report between title and table are printed.
  const std::size_t begin = report.find("\n\n") + 2;
  fmt::print("\n{}\nreference {}\n\nwritten   {}.csv, .json, .md", table.text(),
             report.substr(begin, report.find("\n\n|") - begin), path);
  try
  {
    std::error_code ignored;
    for (const char* extension : { ".png", ".svg" })
      std::filesystem::remove(path + extension, ignored);  // without gnuplot the plot of an earlier study would stay
    write_plot(accuracy_plot(findings, title), path);
    fmt::print(", .png, .svg\n");
  }
  catch (const Error& error)
  {
    fmt::print("\nno plot   {}\n", error.what());
  }
}

void choose(const AccuracyFindings& findings, const AccuracyOptions& options)
{
  if (options.tolerance <= 0 && options.time <= 0)
    return;
  const AccuracyRow& row = options.tolerance > 0 ? cheapest_within(findings, 1e-3 * options.tolerance)
                                                 : most_accurate_within(findings, options.time);
  const std::string profile = profile_text(row, "chosen", findings.machine);
  fmt::print("chosen    {}: error {:.3g} mm RMS, {:.3g} mm at most; {:.3g} s per simulated second{}\n\n  {}\n",
             row.name, 1e3 * row.error.rms, 1e3 * row.error.largest, row.cost,
             row.is_noisy() ? " (timed on a disturbed machine)" : "", profile);
  if (!options.save.empty())
  {
    write_text(options.save, fmt::format("# {}, as measured by: frontalis accuracy {}\n{}\n", row.name,
                                         options.source.path, profile));
    fmt::print("\nwritten   {0}; use it with --accuracy {0}\n", options.save);
  }
}

void study(AccuracyOptions options)
{
  if (options.tolerance > 0 && options.time > 0)
    throw WrongUsage("--tolerance and --time: only one of the two may be given");
  if (!options.save.empty() && options.tolerance <= 0 && options.time <= 0)
    throw WrongUsage("--save goes with --tolerance or --time");
  ClosedForm subject = accuracy_subject(options);
  if (options.folder.empty())
    options.folder = "accuracy_" + subject.name;
  subject.plan.folder = options.folder;

  Progress progress;
  int count = 0;
  std::string last;
  double left_then = 0;
  const AccuracyFindings findings = study_accuracy(
      subject.plan, subject.maker,
      [&](const std::string& stage, double done, double left)
      {
        if (stage != last || done == 0)
        {
          ++count;
          left_then = left;
        }
        last = stage;
        progress.update(
            fmt::format("{}: {}{}", count, stage, left_then > 0 ? ", then about " + time_text(left_then) : ""), done);
        return !interrupt_requested();
      });
  progress.clear();
  if (!findings.complete)
  {
    fmt::print(stderr, "finished settings are kept in {}; the same command goes on from there\n", options.folder);
    throw Interrupted();
  }
  write_outputs(findings, options, "Accuracy against time: " + subject.name);
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

void add_accuracy_command(CLI::App& app)
{
  const auto options = std::make_shared<AccuracyOptions>();
  CLI::App* command = app.add_subcommand(
      "accuracy", "measure what each setting of a scene costs and how accurate it is, and choose one");
  command
      ->add_option("SCENE", options->source.path,
                   "scene file (YAML), or a body with a closed form: cantilever, stretched_block, active_bar")
      ->required();
  add_scene_options(*command, options->source);
  command
      ->add_option("--knobs", options->knobs,
                   "vary only these, without combinations: voxel, samples, fill_min, boundary, hourglass, integration, "
                   "precision, share, time_step, mass_scaling, bulk_modulus_max, time_scaling, backend, profiles")
      ->delimiter(',');
  add_positive(*command, "--voxels", options->voxels, "voxel edges, coarse to fine [mm]; the last is the reference's")
      ->delimiter(',');
  command->add_flag("--quick", options->quick, "fewer settings and a shorter motion, for a study of minutes");
  add_positive(*command, "--budget", options->budget,
               "wall seconds that the study may take (280 with --quick, else all it needs)");
  command->add_option("--expression", options->expression, "the expression to activate (the scene's first one)");
  add_positive(*command, "--ramp", options->ramp, "seconds over which activations grow (0.3)");
  add_positive(*command, "--hold", options->hold, "seconds for which they are held (0.3)");
  add_positive(*command, "--tolerance", options->tolerance,
               "choose the cheapest setting whose skin has at most this RMS error [mm]");
  add_positive(*command, "--time", options->time,
               "choose the most accurate setting that takes at most so many wall seconds per simulated second");
  command->add_option("--save", options->save, "write the chosen profile to this file, for --accuracy");
  command->add_option("-o,--output", options->folder, "folder for results and finished variants (accuracy_SCENE)");
  add_solver_options(*command, options->solver);
  command->callback([options] { study(*options); });
}

}  // namespace frontalis
