#include "cli/command_options.hpp"
#include "cli/model_source.hpp"

#include "frontalis/error.hpp"
#include "frontalis/study/effect_costs.hpp"
#include "frontalis/study/plot.hpp"
#include "frontalis/study/table.hpp"
#include "frontalis/study/voxel_model.hpp"

#include <fmt/core.h>

#include <unistd.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <memory>
#include <thread>
#include <vector>

namespace frontalis
{
namespace
{

struct BenchOptions
{
  ModelSource source;
  SolverSettings solver{ "cpu" };
  bool quick = false;
  bool effects = false;
  std::string plot;
};

// Resident memory of this process after freed memory was returned to the system [bytes]; 0 if it is unknown.
double resident_bytes()
{
#ifdef __GLIBC__
  ::malloc_trim(0);
#endif
  std::ifstream file("/proc/self/statm");
  double size = 0, resident = 0;
  file >> size >> resident;
  return resident * static_cast<double>(::sysconf(_SC_PAGESIZE));
}

std::string percent(double share) { return fmt::format("{:.{}f} %", 100 * share, share < 0.1 ? 2 : 0); }

// Wall times of five repetitions of a task, ascending [s].
template <class Task>
std::vector<double> times_of(const Task& task)
{
  std::vector<double> times;
  for (int repetition = 0; repetition < 5; ++repetition)
  {
    const double start = wall_seconds();
    task();
    times.push_back(wall_seconds() - start);
  }
  std::sort(times.begin(), times.end());
  return times;
}

// Time of a check and a snapshot of the guard, divided by the time of the steps between two checks.
double guard_share(Solver& solver, double step)
{
  std::unique_ptr<Snapshot> snapshot;
  const auto check = [&]
  {
    solver.save(snapshot);
    solver.monitor();
  };
  check();
  return times_of(check)[2] / (solver.steps_per_check() * step);
}

// Fraction of the time per step in which the CPU finds the critical time step. Normally this happens once in 32 steps.
// A motion of a single step does it in each step, and the difference in time is the cost.
double bound_share(Solver& solver, const Controls& controls, double step)
{
  const double dt = 0.999 * solver.time_step();
  const double looking = times_of(
      [&]
      {
        for (int i = 0; i < 16; ++i)
          solver.advance(dt, controls);
      })[2];
  return std::max(0.0, looking / 16 / step - 1) / 31;
}

// Wall seconds per step in five repetitions, ascending.
std::vector<double> time_steps(Solver& solver, const Controls& controls, double seconds)
{
  const double dt = solver.time_step();
  solver.advance(8 * dt, controls);
  const auto steps = [&] { return static_cast<double>(solver.profile().steps); };
  double start = wall_seconds(), before = steps();
  // The loop advances by several plans of steps, because a GPU solver queues some plans without waiting for them.
  do
    solver.advance(32 * dt, controls);
  while (wall_seconds() - start < 0.05);
  const double guess = (wall_seconds() - start) / (steps() - before);
  std::vector<double> times;
  for (int repetition = 0; repetition < 5; ++repetition)
  {
    before = steps();
    start = wall_seconds();
    solver.advance(std::max(16.0, seconds / 5 / guess) * dt, controls);
    times.push_back((wall_seconds() - start) / (steps() - before));
  }
  std::sort(times.begin(), times.end());
  return times;
}

constexpr const char* row_format = "{:<12} {:>10}  {:>9}  {:>9}  {:>6}  {:>6}  {:>7}  {:>7}  {:>7}  {}\n";

// Prints a row and returns the voxels per second. `block_rate`: voxels per second of the dense block to compare with,
// or 0 for that block itself.
double bench_model(const std::string& name, const std::shared_ptr<const Model>& model, const BenchOptions& options,
                   double block_rate)
{
  const double before = resident_bytes();
  const auto solver = make_solver(model, options.solver);
  Controls controls = solver->controls();
  std::fill(controls.activation.begin(), controls.activation.end(), 0.75f);
  const std::vector<double> times = time_steps(*solver, controls, options.quick ? 1.5 : 5.0);
  const double step = times[2], spread = (times[4] - times[0]) / step;
  const auto voxels = static_cast<double>(model->voxels.size());
  const double bytes = (resident_bytes() - before) / voxels;
  const std::string description = solver->description();
  const bool on_cpu = description.compare(0, 3, "cpu") == 0;
  const auto fixed = [](double value, int digits) { return fmt::format("{:.{}f}", value, digits); };
  fmt::print(row_format, name, voxels, fixed(1e6 * step, 1), fixed(1e-6 * voxels / step, 2),
             fixed(block_rate > 0 ? voxels / step / block_rate : 1, 2), fixed(bytes, 0), percent(spread),
             on_cpu ? percent(bound_share(*solver, controls, step)) : "", percent(guard_share(*solver, step)),
             description);
  std::fflush(stdout);
  return voxels / step;
}

// Plots each effect's cost over the fraction of voxels that have the effect.
void draw(const std::vector<PresenceCost>& costs, const std::string& backend, const std::string& path)
{
  Plot plot{ "Cost of an effect against its extent: " + backend,
             "voxels (sliding, friction: nodes of a face) that have the effect [%]", "additional time per step [%]" };
  plot.key = "top left";
  for (const PresenceCost& cost : costs)
  {
    if (cost.share == 0)
      plot.curves.push_back({ name_of(cost.effect) });
    plot.curves.back().x.push_back(100 * cost.share);
    plot.curves.back().y.push_back(100 * cost.step.median / cost.base);
  }
  write_plot(plot, path);
}

void bench_effects(const BenchOptions& options)
{
  const double seconds = options.quick ? 1.0 : 4.0;
  // Options and model are checked before the measurement, which takes minutes.
  const std::string plot = plot_path(options.plot);
  std::shared_ptr<const Model> model;
  if (!options.source.path.empty())
    model = std::make_shared<const Model>(obtain_model(options.source));
  if (model && model->muscles.empty())
    throw Error(options.source.path + ": has no muscles; to compare one with all it must have some");
  end_at_interrupt();
  const auto costs = measure_presence(options.solver, seconds);
  Table table({ "effect", "share [%]", "additional [us]", "spread [us]", "of base step [%]", "of full cost [%]" });
  const auto rounded = [](double x, double unit) { return std::round(x / unit) * unit; };
  const std::size_t shares = presence_shares().size();
  for (std::size_t c = 0; c < costs.size(); ++c)
  {
    const PresenceCost &cost = costs[c], &whole = costs[c - c % shares + shares - 1];
    table.add({ name_of(cost.effect), 100 * cost.share, rounded(1e6 * cost.step.median, 0.01),
                rounded(1e6 * cost.step.half, 0.01), rounded(100 * cost.step.median / cost.base, 0.1),
                rounded(100 * cost.step.median / whole.step.median, 0.1) });
  }
  fmt::print("{}", table.text());
  if (model)
  {
    const ActivationCost cost = measure_activation(model, options.solver, step_timer(options.solver, seconds));
    fmt::print("one muscle active: {:.2f} us per step; all: {:.2f} us; spread of the difference {:.2f} us\n",
               1e6 * cost.one, 1e6 * cost.all, 1e6 * cost.spread);
  }
  // The plot is drawn last, so that the figures are printed even if drawing fails.
  if (!plot.empty())
    draw(costs, options.solver.backend, plot);
}

void bench(const BenchOptions& options)
{
  if (options.effects)
    return bench_effects(options);
  if (!options.plot.empty())
    throw WrongUsage("--plot: only with --effects");
  const auto given =
      options.source.path.empty() ? nullptr : std::make_shared<const Model>(obtain_model(options.source));
  end_at_interrupt();
  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  const int threads = options.solver.threads > 0 ? options.solver.threads : cores;
  fmt::print("this machine {} threads: copies {:.1f} GB/s\n", threads, 1e-9 * copy_bandwidth(threads));
  fmt::print(row_format, "scene", "voxels", "us/step", "million/s", "/ block", "B/vox", "spread", "bound", "guard",
             "backend");
  double rate = 0;
  for (const std::int32_t edge :
       options.quick ? std::vector<std::int32_t>{ 64 } : std::vector<std::int32_t>{ 64, 32, 128 })
  {
    const auto block = std::make_shared<const Model>(dense_block(edge, edge, edge));
    const double rate_of_block = bench_model(fmt::format("block {}", edge), block, options, rate);
    rate = rate > 0 ? rate : rate_of_block;
  }
  if (given)
    bench_model("model", given, options, rate);
}

}  // namespace

void add_bench_command(CLI::App& app)
{
  auto options = std::make_shared<BenchOptions>();
  CLI::App* command = app.add_subcommand(
      "bench", "time the solver on dense blocks, whose speed others are compared with, and on a model");
  CLI::Option* const scene = command->add_option("SCENE_OR_MODEL", options->source.path,
                                                 "time this model too, every muscle at activation 0.75");
  add_scene_options(*command, options->source);
  for (const char* const option : { "--mesh-dir", "--accuracy", "--voxel" })
    command->get_option(option)->needs(scene);
  add_solver_options(*command, options->solver);
  command->add_flag("--quick", options->quick, "only the block of 64^3 voxels, a few seconds");
  command->add_flag("--effects", options->effects,
                    "time effects that a fraction of the voxels has; on SCENE_OR_MODEL, one active muscle against all");
  command->add_option("--plot", options->plot, "draw the result of --effects: FILE.png, and FILE.svg beside it");
  command->callback([options] { bench(*options); });
}

}  // namespace frontalis
