#include "cli/command_options.hpp"
#include "cli/model_source.hpp"

#include "frontalis/study/effect_costs.hpp"
#include "frontalis/study/plot.hpp"
#include "frontalis/study/table.hpp"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

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
  SolverSettings solver;
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
    const auto microseconds = [&](double x) { return timed ? std::round(1e8 * x) / 100 : none; };
    table.add({ name_of(cost.effect), std::string(cost.presence.present ? "on" : "off"), why(cost, costs.field),
                count(cost.presence.voxels), count(cost.presence.nodes), static_cast<double>(cost.bytes),
                microseconds(cost.step.median), microseconds(cost.step.half),
                timed ? std::round(1000 * cost.step.median / costs.step) / 10 : none });
  }
  return table;
}

std::string json_of(const Model& model, const EffectCosts& costs)
{
  return json_text({ { "backend", costs.backend },
                     { "voxels", model.voxels.size() },
                     { "nodes", model.nodes.size() },
                     { "step_us", 1e6 * costs.step },
                     { "plain_step_us", 1e6 * costs.plain_step },
                     { "activation", costs.activation },
                     { "field_us", 1e6 * costs.field },
                     { "effects", nlohmann::ordered_json::parse(table_of(costs).json()) } });
}

void draw(const EffectCosts& costs, const std::string& path)
{
  Plot plot;
  plot.title = "What effects cost: " + costs.backend;
  plot.y_label = "time per step [us]";
  plot.key = "off";
  Plot::Curve bars{ "", {}, {}, Plot::Style::bars };
  const auto add = [&](const std::string& name, double seconds)
  {
    plot.x_names.push_back(name + " (" + readable(std::round(100 * seconds / costs.step)) + " %)");
    bars.add(static_cast<double>(bars.x.size()), 1e6 * seconds);
  };
  add("whole step", costs.step);
  add("plain neo-Hookean", costs.plain_step);
  for (const EffectCost& cost : costs.effects)
    if (cost.presence.present && cost.effect != Effect::output_fields)
      add(name_of(cost.effect), cost.step.median);
  plot.curves.push_back(bars);
  write_plot(plot, path);
}

// Prints the size of each of the solver's arrays [bytes].
void show_arrays(const EffectsOptions& options)
{
  const auto solver = make_solver(std::make_shared<const Model>(obtain_model(options.source)), options.solver);
  Table table({ "effect", "array", "bytes" });
  for (const Allocation& allocation : solver->allocations())
    table.add({ name_of(allocation.effect), allocation.what, static_cast<double>(allocation.bytes) });
  fmt::print("{}", options.json ? table.json() : table.text());
}

void print(const Model& model, const EffectCosts& costs)
{
  fmt::print(
      "{}a step takes {} us with all of them, {} us as a plain neo-Hookean step of the same {} voxels: {} times\n",
      table_of(costs).text(), readable(1e6 * costs.step, 4), readable(1e6 * costs.plain_step, 4), model.voxels.size(),
      readable(costs.step / costs.plain_step, 3));
  fmt::print("on {}; every muscle at activation {}{}\n", costs.backend, readable(costs.activation, 2),
             costs.activation > 0.74 ? "" : ", since more --seconds are needed to reach 0.75");
}

void show_effects(const EffectsOptions& options)
{
  const std::string plot = plot_path(options.plot);
  if (options.arrays)
    return show_arrays(options);
  check_seconds(options.seconds);
  const auto model = std::make_shared<const Model>(obtain_model(options.source));
  end_at_interrupt();
  const EffectCosts costs = measure_effects(model, options.solver, step_timer(options.solver, options.seconds));
  if (options.json)
    fmt::print("{}", json_of(*model, costs));
  else
    print(*model, costs);
  // The plot is drawn last, so that the figures are printed even if drawing fails.
  std::fflush(stdout);
  if (!plot.empty())
    draw(costs, plot);
}

}  // namespace

void add_effects_command(CLI::App& app)
{
  const auto options = std::make_shared<EffectsOptions>();
  CLI::App* command = app.add_subcommand("effects", "list the effects of a scene or a baked model and what each costs");
  command->add_option("SCENE_OR_MODEL", options->source.path, "scene (YAML) or baked model (.vtkhdf)")->required();
  add_scene_options(*command, options->source);
  add_solver_options(*command, options->solver);
  add_positive(*command, "--seconds", options->seconds, "wall seconds for which each effect is timed (2)");
  command->add_flag("--json", options->json, "JSON instead of a table");
  command->add_flag("--arrays", options->arrays, "list the bytes of each of the solver's arrays instead of timing")
      ->excludes(
          command->add_option("--plot", options->plot, "draw the costs as bars: FILE.png, and FILE.svg beside it"));
  command->callback(
      [options]
      {
        // With --json, stdout receives nothing but the JSON.
        if (options->json)
          options->source.progress = stderr;
        show_effects(*options);
      });
}

}  // namespace frontalis
