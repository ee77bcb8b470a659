#include "cli/chosen_cases.hpp"
#include "cli/interrupt.hpp"
#include "cli/progress.hpp"
#include "cli/solver_options.hpp"
#include "cli/stability_scenes.hpp"

#include "frontalis/error.hpp"
#include "frontalis/model/model_file.hpp"
#include "frontalis/study/stability.hpp"

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include <cstdio>
#include <memory>

namespace frontalis
{
namespace
{

struct StabilityOptions
{
  std::vector<std::string> only;
  std::string backend = "cpu";
  std::string cases, json, table, markdown, models;
  StabilityScenes scenes;
  bool all = false;
};

void run_stability(const StabilityOptions& options)
{
  const auto cases = chosen_cases(stability_cases(stability_folder(options.cases)), options.only, options.all);
  Progress progress(Progress::OffTerminal::silent);
  std::string name;
  StabilitySettings settings;
  settings.backend = backend_from_name(options.backend);
  settings.long_runs = options.all;
  settings.scene = [&](const std::string& scene) { return stability_scene(options.scenes, scene); };
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
  if (failed > 0)
    throw Error(fmt::format("{} of {} cases failed", failed, ran));
  fmt::print("all {} cases passed in {:.0f} s{}\n", ran, seconds,
             skipped > 0 ? fmt::format(", {} skipped", skipped) : "");
}

}  // namespace

void add_stability_command(CLI::App& app, Action& action)
{
  auto options = std::make_shared<StabilityOptions>();
  CLI::App* command =
      app.add_subcommand("stability", "run motions that explicit codes fail at, and check that each holds");
  command->add_option("--only", options->only, "cases to run, by name");
  command->add_flag("--all", options->all, "run long cases too, and all of them in full length");
  add_backend_option(*command, options->backend, named_backends());
  command->add_option("--cases", options->cases, "folder of the cases' files (found beside the program)");
  command->add_option("--mesh-dir", options->scenes.mesh_directory,
                      "folder of the real head's meshes, which its case needs");
  command->add_option("--scenes", options->scenes.folder,
                      "folder of the cases' scenes, or of models baked from them (found beside the program)");
  command->add_option("--models", options->models, "write the model of each motion to this folder");
  command->add_option("--json", options->json, "write the figures to this file");
  command->add_option("--table", options->table, "write the table to this file, as markdown");
  command->add_option("--markdown", options->markdown,
                      "write stability.md to this folder, and its plots to its folder stability");
  command->callback([options, &action] { action = [options] { run_stability(*options); }; });
}

}  // namespace frontalis
