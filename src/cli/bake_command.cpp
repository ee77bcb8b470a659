#include "cli/command.hpp"
#include "cli/model_source.hpp"

#include "frontalis/error.hpp"
#include "frontalis/model/effects.hpp"
#include "frontalis/model/model_file.hpp"
#include "frontalis/physics/number.hpp"
#include "frontalis/solver/rigid_motion.hpp"
#include "frontalis/study/step_time.hpp"

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
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

// Prints the number and name of each constraint, and how many nodes it restricts.
void print_constraints(const Model& model)
{
  for (std::size_t c = 0; c < model.constraints.size(); ++c)
    fmt::print("held by  {} {}: {}\n", c, model.constraints[c],
               restricted_nodes_text(model, static_cast<std::int32_t>(c)));
}

double area_of(const TriangleMesh& mesh)
{
  double sum = 0;
  for (const auto& corners : mesh.triangles)
  {
    const auto edge = [&](std::size_t to)
    { return vector_of(mesh.vertices[corners[to]]) - vector_of(mesh.vertices[corners[0]]); };
    const auto normal = cross(edge(1), edge(2));
    sum += 0.5 * std::sqrt(dot(normal, normal));
  }
  return sum;
}

// Prints each load, and on which area or how many nodes it acts.
void print_loads(const Model& model)
{
  for (std::size_t l = 0; l < model.loads.size(); ++l)
  {
    const Load& load = model.loads[l];
    const auto acts = [&](const PrescribedNode& node) { return node.load == static_cast<std::int32_t>(l); };
    if (load.kind == Load::Kind::displacement)
      fmt::print("load     {}: displacement of {} nodes\n", load.name,
                 std::count_if(model.prescribed.begin(), model.prescribed.end(), acts));
    else
      fmt::print("load     {}: {} on {:.4g} cm2\n", load.name,
                 load.kind == Load::Kind::pressure ? "pressure" : "traction", 1e4 * area_of(load.mesh));
  }
}

void bake_to_file(const BakeOptions& options)
{
  check_model_output(options.output);
  if (is_model_file(options.source.path) && std::filesystem::exists(options.source.path))
    throw Error(options.source.path + ": is already a baked model; must be a scene (YAML)");
  const double begin = wall_seconds();
  BakeSummary summary;
  summary.whole = options.report;
  const Model model = bake_scene(options.source, &summary);
  write_model(model, options.output);
  const double seconds = wall_seconds() - begin;

  fmt::print("{}", summary.stages);
  for (const std::string& warning : summary.warnings)
    fmt::print("warning  {}\n", warning);
  if (options.report)
  {
    for (const std::string& finding : summary.findings)
      fmt::print("finding  {}\n", finding);
    print_constraints(model);
    print_loads(model);
    fmt::print("{}", summary.tables);
  }
  fmt::print("voxels   {} of {:g} x {:g} x {:g} mm\n", model.voxels.size(), model.spacing[0] * 1e3,
             model.spacing[1] * 1e3, model.spacing[2] * 1e3);
  fmt::print("nodes    {}, of which {}\n", model.nodes.size(), restricted_nodes_text(model));
  fmt::print("muscles  {}\n", model.muscles.size());
  fmt::print("skin     {} vertices, {} triangles\n", model.skin.vertices.size(), model.skin.triangles.size());
  if (!options.report && !summary.findings.empty())
    fmt::print("findings {}; bake --report prints them\n", summary.findings.size());
  fmt::print("written  {} in {:.2f} s\n", options.output, seconds);
}

}  // namespace

void add_bake_command(CLI::App& app)
{
  CLI::App* command = app.add_subcommand("bake", "build the model of a scene and write it to a file");
  const auto options = std::make_shared<BakeOptions>();
  command->add_option("SCENE", options->source.path, "scene file (YAML)")->required();
  command->add_option("-o,--output", options->output, "model file to write (.vtkhdf)")->required();
  command->add_flag("--report", options->report,
                    "print all findings, what constraints hold and where loads act, extents of the surfaces, and the "
                    "muscles' volumes "
                    "beside those of their meshes");
  command->add_option("--surfaces", options->source.surfaces,
                      "folder to write the scene's surfaces to, as made or repaired (OBJ, metres)");
  command->add_option(
      "--cache", options->source.cache,
      "folder that keeps models by the content of their scenes: a model is taken from there, or baked and kept there");
  add_scene_options(*command, options->source);
  command->callback([options] { bake_to_file(*options); });
}

}  // namespace frontalis
