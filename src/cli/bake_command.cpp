#include "cli/command.hpp"
#include "cli/model_source.hpp"

#include "frontalis/error.hpp"
#include "frontalis/model/model_file.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>

namespace frontalis
{
namespace
{

struct BakeOptions
{
  ModelSource source;
  std::string output;
  bool report = false;
};

// what would make the work of a bake be in vain is found before it
void check_output(const BakeOptions& options)
{
  const std::filesystem::path folder = std::filesystem::absolute(options.output).parent_path();
  std::error_code ignored;
  if (!std::filesystem::is_directory(folder, ignored))
    throw Error(options.output + ": no folder '" + folder.string() + "' to write it in; must exist");
  if (std::filesystem::is_directory(options.output, ignored))
    throw Error(options.output + ": is a folder; must be the path of a model file (.vtkhdf)");
  if (std::filesystem::equivalent(options.output, options.source.path, ignored))
    throw Error(options.output + ": is the scene itself; must be another file");
}

// how many nodes each constraint holds, with the number by which the file calls it
void print_constraints(const Model& model)
{
  for (std::size_t c = 0; c < model.constraints.size(); ++c)
  {
    const auto holds = [c](const auto& node) { return node.constraint == static_cast<std::int32_t>(c); };
    std::printf("held by  %zu %s: rigid %td, sliding %td\n", c, model.constraints[c].c_str(),
                std::count_if(model.rigid.begin(), model.rigid.end(), holds),
                std::count_if(model.sliding.begin(), model.sliding.end(), holds));
  }
}

void bake_to_file(const BakeOptions& options)
{
  check_output(options);
  if (is_model_file(options.source.path) && std::filesystem::exists(options.source.path))
    throw Error(options.source.path + ": is a model that is baked already; must be a scene (YAML)");
  const auto begin = std::chrono::steady_clock::now();
  BakeSummary summary;
  summary.whole = options.report;
  const Model model = bake_scene(options.source, &summary);
  write_model(model, options.output);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();

  if (!summary.cache.empty())
    std::printf("cache    %s\n", summary.cache.c_str());
  for (const std::string& stage : summary.stages)
    std::printf("stage    %s\n", stage.c_str());
  if (options.report)
  {
    for (const std::string& finding : summary.findings)
      std::printf("finding  %s\n", finding.c_str());
    print_constraints(model);
    for (const std::string& muscle : summary.muscles)
      std::printf("muscle   %s\n", muscle.c_str());
  }
  std::printf("voxels   %zu of %g x %g x %g mm\n", model.voxels.size(), model.spacing[0] * 1e3, model.spacing[1] * 1e3,
              model.spacing[2] * 1e3);
  std::printf("nodes    %zu, of which rigid %zu, sliding %zu\n", model.nodes.size(), model.rigid.size(),
              model.sliding.size());
  std::printf("muscles  %zu\n", model.muscles.size());
  std::printf("skin     %zu vertices, %zu triangles\n", model.skin.vertices.size(), model.skin.triangles.size());
  if (!options.report && !summary.findings.empty())
    std::printf("findings %zu; --report prints them\n", summary.findings.size());
  std::printf("written  %s in %.2f s\n", options.output.c_str(), seconds);
}

}  // namespace

void add_bake_command(CLI::App& app, Action& action)
{
  CLI::App* command = app.add_subcommand("bake", "build the model of a scene and write it to a file");
  const auto options = std::make_shared<BakeOptions>();
  command->add_option("SCENE", options->source.path, "scene file (YAML)")->required();
  command->add_option("-o,--output", options->output, "model file to write (.vtkhdf)")->required();
  command->add_flag("--report", options->report,
                    "print all that was found, and the muscles' volumes beside those of their meshes");
  command->add_option(
      "--cache", options->source.cache,
      "folder of models by their scenes' content: the model is taken from there, or baked and left there");
  add_scene_options(*command, options->source);
  command->callback([&action, options] { action = [options] { bake_to_file(*options); }; });
}

}  // namespace frontalis
