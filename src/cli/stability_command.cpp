#include "cli/command_options.hpp"
#include "cli/model_source.hpp"
#include "cli/progress.hpp"

#include "frontalis/error.hpp"
#include "frontalis/model/model_file.hpp"
#include "frontalis/study/stability.hpp"
#include "frontalis/study/table.hpp"

#include <fmt/core.h>

#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>

namespace frontalis
{
namespace
{

namespace fs = std::filesystem;

struct StabilityOptions
{
  std::vector<std::string> only;
  StabilitySettings settings;
  std::string cases, json, table, markdown, models;
  std::string scenes;          ///< folder of the cases' scenes; empty: found by stability_scene()
  std::string mesh_directory;  ///< folder of the meshes of the real head and face
};

// The folder of the cases' files: `given` or, if that is empty, the folder beside the program or in the sources.
std::string stability_folder(const std::string& given)
{
  if (!given.empty())
    return given;
  for (const fs::path& folder : package_places("stability", "stability", "test/stability"))
    if (fs::is_directory(folder))
      return folder.lexically_normal().string();
  throw Error(
      "the files of the hard cases (stability/*.yaml) are not beside the program; --cases must name their folder");
}

// Reads or bakes the model of the scene called `name`. Throws Skipped if this build cannot bake or the scene needs
// meshes that were not given.
std::shared_ptr<const Model> stability_scene(const StabilityOptions& options, const std::string& name)
{
  const bool real = name == "real_head" || name == "real_face";
  if (real && options.mesh_directory.empty())
    throw Skipped{ "needs meshes (--mesh-dir)" };
  std::vector<fs::path> places{ options.scenes };
  if (options.scenes.empty())
  {
    places = package_places("config", "models/stability", "config");
    places.push_back(fs::path(stability_folder(options.cases)) / "scenes");
  }
  for (const fs::path& folder : places)
  {
    const fs::path model = folder / (name + ".vtkhdf");
    if (fs::exists(model))
      return std::make_shared<const Model>(read_model(model.string()));
    ModelSource scene;
    scene.path = folder / (name + ".yaml");
    if (!fs::exists(scene.path))
      continue;
#ifdef FRONTALIS_WITH_BAKE
    if (real)
      scene.scene.mesh_directory = options.mesh_directory;
    return std::make_shared<const Model>(bake_scene(scene));
#else
    throw Skipped{ "this build bakes no scenes, and there is no " + name + ".vtkhdf" };
#endif
  }
  if (!options.scenes.empty())
    throw Error(options.scenes + ": has neither " + name + ".yaml nor " + name + ".vtkhdf");
  throw Skipped{ "no " + name + ".yaml or .vtkhdf here (--scenes)" };
}

void run_stability(const StabilityOptions& options)
{
  check_output(options.json);
  check_output(options.table);
  const auto cases =
      chosen_cases(stability_cases(stability_folder(options.cases)), options.only, options.settings.long_runs);
  Progress progress(nullptr);
  std::string name;
  StabilitySettings settings = options.settings;
  std::map<std::string, std::shared_ptr<const Model>> scenes;  // several cases have the same scene
  settings.scene = [&](const std::string& scene)
  {
    std::shared_ptr<const Model>& model = scenes[scene];
    if (!model)
      model = stability_scene(options, scene);
    return model;
  };
  settings.watch = [&](double done)
  {
    progress.update(name, done);
    if (interrupt_requested())
      throw Interrupted();
  };
  int motion = 0;
  if (!options.models.empty())
  {
    make_folder(options.models);
    settings.model = [&](const Model& model)
    { write_model(model, fmt::format("{}/{}_{}.vtkhdf", options.models, name, ++motion)); };
  }
  Trials trials;
  int failed = 0, skipped = 0;
  double seconds = 0;
  fmt::print("{}\n", trial_heading());
  std::fflush(stdout);
  for (const auto& c : cases)
  {
    name = c.name;
    motion = 0;
    const Trial trial = run_case(c, settings);
    progress.clear();
    fmt::print("{}\n", trial_line(c, trial));
    std::fflush(stdout);
    failed += trial.passed() ? 0 : 1;
    skipped += trial.skipped.empty() ? 0 : 1;
    seconds += trial.seconds;
    trials.emplace_back(c, trial);
  }
  if (!options.json.empty())
    write_text(options.json, trials_json(trials));
  if (!options.table.empty())
    write_text(options.table, trials_markdown(trials));
  if (!options.markdown.empty())
    write_stability(trials, options.markdown);
  const int ran = static_cast<int>(cases.size()) - skipped;
  if (ran == 0 && skipped > 0)
    throw Error("no case was run: " + trials.front().second.skipped);
  if (failed > 0)
    throw Error(fmt::format("{} of {} cases failed", failed, ran));
  fmt::print("all {} cases passed in {:.0f} s{}\n", ran, seconds,
             skipped > 0 ? fmt::format(", {} skipped", skipped) : "");
}

}  // namespace

void add_stability_command(CLI::App& app)
{
  const auto options = std::make_shared<StabilityOptions>();
  CLI::App* command =
      app.add_subcommand("stability", "run motions that explicit codes fail at, and check that each holds");
  command->add_option("--only", options->only, "cases to run, by name");
  command->add_flag("--all", options->settings.long_runs, "run long cases too, and all of them in full length");
  add_backend_option(*command, options->settings.backend, false);
  command->add_option("--cases", options->cases, "folder of the cases' files (found beside the program)");
  command->add_option("--mesh-dir", options->mesh_directory, "folder of the real head's meshes, which its cases need");
  command->add_option("--scenes", options->scenes,
                      "folder of the cases' scenes, or of models baked from them (found beside the program)");
  command->add_option("--models", options->models, "write the model of each motion to this folder");
  command->add_option("--json", options->json, "write the figures to this file");
  command->add_option("--table", options->table, "write the table to this file, as markdown");
  command->add_option("--markdown", options->markdown,
                      "write stability.md, with all checks, to this folder, and plots to its folder stability");
  command->callback([options] { run_stability(*options); });
}

}  // namespace frontalis
