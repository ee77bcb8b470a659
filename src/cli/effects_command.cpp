#include "cli/command.hpp"
#include "cli/model_source.hpp"
#include "cli/plot_path.hpp"

#include "frontalis/error.hpp"
#include "frontalis/study/effect_costs.hpp"
#include "frontalis/study/plot.hpp"
#include "frontalis/study/table.hpp"

#include <CLI/CLI.hpp>

#include <cmath>
#include <cstdio>
#include <memory>

namespace frontalis
{
namespace
{

struct EffectsOptions
{
  ModelSource source;
  std::string backend = "auto";
  int threads = 0;
  double seconds = 2;
  bool json = false;
  bool arrays = false;
  std::string plot;
};

std::string why(const EffectCost& cost, double field)
{
  if (cost.effect != Effect::output_fields || !cost.presence.present)
    return cost.presence.why;
  return cost.presence.why + ", " + readable(1e3 * field, 3) + " ms each time";
}

Table table_of(const EffectCosts& costs)
{
  Table table({ "effect", "on", "why", "voxels", "nodes", "bytes", "step [us]", "spread [us]", "share [%]" });
  const double none = std::nan("");
  for (const EffectCost& cost : costs.effects)
  {
    const bool timed = cost.presence.present && cost.effect != Effect::output_fields;
    const auto count = [&](std::size_t n) { return n > 0 ? static_cast<double>(n) : none; };
    const auto rounded = [&](double x) { return timed ? std::round(1e8 * x) / 100 : none; };
    table.add({ name_of(cost.effect), std::string(cost.presence.present ? "on" : "off"), why(cost, costs.field),
                count(cost.presence.voxels), count(cost.presence.nodes), static_cast<double>(cost.bytes),
                rounded(cost.step), rounded(cost.spread),
                timed ? std::round(1000 * cost.step / costs.step) / 10 : none });
  }
  return table;
}

std::string json_of(const Model& model, const EffectCosts& costs)
{
  const auto number = [](double x)
  {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", x);
    return std::string(text);
  };
  return "{\n\"backend\": " + json_string(costs.backend) + ",\n\"voxels\": " + std::to_string(model.voxels.size()) +
         ",\n\"nodes\": " + std::to_string(model.nodes.size()) + ",\n\"step_us\": " + number(1e6 * costs.step) +
         ",\n\"plain_step_us\": " + number(1e6 * costs.plain_step) + ",\n\"field_us\": " + number(1e6 * costs.field) +
         ",\n\"effects\": " + table_of(costs).json() + "}\n";
}

void draw(const EffectCosts& costs, const std::string& path)
{
  Plot plot;
  plot.title = "What effects cost: " + costs.backend;
  plot.y_label = "of a step [us]";
  plot.key = "off";
  Plot::Curve bars{ "", {}, {}, Plot::Style::bars };
  const auto add = [&](const std::string& name, double seconds)
  {
    plot.x_names.push_back(name + " (" + readable(std::round(100 * seconds / costs.step)) + " %)");
    bars.x.push_back(static_cast<double>(bars.x.size()));
    bars.y.push_back(1e6 * seconds);
  };
  add("whole step", costs.step);
  add("plain neo-Hookean", costs.plain_step);
  for (const EffectCost& cost : costs.effects)
    if (cost.presence.present && cost.effect != Effect::output_fields)
      add(name_of(cost.effect), cost.step);
  plot.curves.push_back(bars);
  write_plot(plot, path);
}

// what a solver's arrays hold
void show_arrays(const EffectsOptions& options)
{
  const auto solver = make_solver(std::make_shared<const Model>(obtain_model(options.source)),
                                  { backend_from_name(options.backend), options.threads, 0 });
  Table table({ "effect", "array", "bytes" });
  for (const Allocation& allocation : solver->allocations())
    table.add({ name_of(allocation.effect), allocation.what, static_cast<double>(allocation.bytes) });
  std::printf("%s", (options.json ? table.json() : table.text()).c_str());
}

void print(const Model& model, const EffectCosts& costs)
{
  std::printf("%s", table_of(costs).text().c_str());
  std::printf(
      "a step takes %s us with all of them, %s us as a plain neo-Hookean one of the same %zu voxels: %s times\n",
      readable(1e6 * costs.step, 4).c_str(), readable(1e6 * costs.plain_step, 4).c_str(), model.voxels.size(),
      readable(costs.step / costs.plain_step, 3).c_str());
  std::printf("on %s; every muscle at activation 0.75\n", costs.backend.c_str());
}

void show_effects(const EffectsOptions& options)
{
  const std::string plot = plot_path(options.plot);
  if (options.arrays)
    return show_arrays(options);
  if (!(options.seconds > 0) || !std::isfinite(options.seconds))
    throw WrongUsage("--seconds: must be a number greater than 0");
  const auto model = std::make_shared<const Model>(obtain_model(options.source));
  const EffectCosts costs =
      measure_effects(model, { backend_from_name(options.backend), options.threads, 0 }, options.seconds);
  if (options.json)
    std::printf("%s", json_of(*model, costs).c_str());
  else
    print(*model, costs);
  // last, so that a plot that fails loses nothing
  std::fflush(stdout);
  if (!plot.empty())
    draw(costs, plot);
}

}  // namespace

void add_effects_command(CLI::App& app, Action& action)
{
  auto options = std::make_shared<EffectsOptions>();
  CLI::App* command = app.add_subcommand("effects", "which effects a scene or a baked model has, and what each costs");
  command->add_option("SCENE_OR_MODEL", options->source.path, "scene (YAML) or baked model (.vtkhdf)")->required();
  add_scene_options(*command, options->source);
  command->add_option("--backend", options->backend, "auto, reference, cpu or cuda (auto)")
      ->check(CLI::IsMember({ "auto", "reference", "cpu", "cuda" }));
  command->add_option("--threads", options->threads, "CPU threads (0: one a core)")->check(CLI::Range(0, 1024));
  command->add_option("--seconds", options->seconds, "wall seconds to time each effect (2)")
      ->check(CLI::PositiveNumber);
  command->add_flag("--json", options->json, "JSON instead of a table");
  command->add_flag("--arrays", options->arrays, "instead of timing, the bytes of each of the solver's arrays")
      ->excludes(
          command->add_option("--plot", options->plot, "draws the costs as bars: FILE.png, and FILE.svg beside it"));
  command->callback([options, &action] { action = [options] { show_effects(*options); }; });
}

}  // namespace frontalis
