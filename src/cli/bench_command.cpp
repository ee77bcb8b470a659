#include "cli/command.hpp"
#include "cli/model_source.hpp"
#include "cli/plot_path.hpp"

#include "frontalis/error.hpp"
#include "frontalis/solver/solver.hpp"
#include "frontalis/study/dense_block.hpp"
#include "frontalis/study/effect_presence.hpp"
#include "frontalis/study/plot.hpp"
#include "frontalis/study/table.hpp"
#include "frontalis/study/yardstick.hpp"

#include <CLI/CLI.hpp>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <algorithm>
#include <chrono>
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
  std::string backend = "cpu";
  int threads = 0;
  bool quick = false;
  bool effects = false;
  std::string plot;
};

// resident memory of this process without what was freed [bytes]; 0 where the system does not tell
double resident_bytes()
{
#ifdef __GLIBC__
  ::malloc_trim(0);
#endif
  std::ifstream file("/proc/self/statm");
  double size = 0, resident = 0;
  file >> size >> resident;
  return resident * 4096;
}

std::string percent(double share)
{
  char text[16];
  std::snprintf(text, sizeof text, share < 0.1 ? "%.2f %%" : "%.0f %%", 100 * share);
  return text;
}

struct Timing
{
  double step = 0;    ///< median [s]
  double spread = 0;  ///< (largest - smallest) over the median
};

using Clock = std::chrono::steady_clock;

double elapsed(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

// median of five repetitions [s]
template <class Task>
double time_of(const Task& task)
{
  std::vector<double> times;
  for (int repetition = 0; repetition < 5; ++repetition)
  {
    const auto start = Clock::now();
    task();
    times.push_back(elapsed(start));
  }
  std::sort(times.begin(), times.end());
  return times[2];
}

// what the guard's checks and snapshots take, as a share of the steps between them
double guard_share(Solver& solver, double step)
{
  std::unique_ptr<Snapshot> snapshot;
  solver.monitor();
  solver.save(snapshot);
  const double check = time_of(
      [&]
      {
        solver.save(snapshot);
        solver.monitor();
      });
  return check / (solver.steps_per_check() * step);
}

// what the looks at the time step take on the CPU, once in 32 steps: a plan of one step has one a step
double look_share(Solver& solver, const Controls& controls, double step)
{
  const double dt = 0.999 * solver.time_step();
  const double looking = time_of(
      [&]
      {
        for (int i = 0; i < 16; ++i)
          solver.advance(dt, controls);
      });
  return std::max(0.0, looking / 16 / step - 1) / 31;
}

Timing time_steps(Solver& solver, const Controls& controls, double seconds)
{
  const double dt = solver.time_step();
  solver.advance(8 * dt, controls);
  auto start = Clock::now();
  const auto first = solver.profile().steps;
  // for a while: a GPU solver queues some steps without waiting for them
  do
    solver.advance(32 * dt, controls);
  while (elapsed(start) < 0.05);
  const double guess = elapsed(start) / static_cast<double>(solver.profile().steps - first);
  std::vector<double> steps;
  for (int repetition = 0; repetition < 5; ++repetition)
  {
    const auto before = solver.profile().steps;
    start = Clock::now();
    solver.advance(std::max(16.0, seconds / 5 / guess) * dt, controls);
    steps.push_back(elapsed(start) / static_cast<double>(solver.profile().steps - before));
  }
  std::sort(steps.begin(), steps.end());
  return { steps[2], (steps[4] - steps[0]) / steps[2] };
}

void bench_model(const std::string& name, const std::shared_ptr<const Model>& model, const BenchOptions& options,
                 double yardstick)
{
  const double before = resident_bytes();
  const auto solver = make_solver(model, { backend_from_name(options.backend), options.threads, 0 });
  Controls controls = solver->controls();
  std::fill(controls.activation.begin(), controls.activation.end(), 0.75f);
  const Timing timing = time_steps(*solver, controls, options.quick ? 1.5 : 5.0);
  const auto voxels = static_cast<double>(model->voxels.size());
  const double bytes = (resident_bytes() - before) / voxels;
  const std::string description = solver->description();
  const std::string look =
      description.compare(0, 3, "cpu") == 0 ? percent(look_share(*solver, controls, timing.step)) : "";
  std::printf("%-12s %10.0f  %9.1f  %9.2f  %6.2f  %6.0f  %7s  %7s  %7s  %s\n", name.c_str(), voxels, 1e6 * timing.step,
              1e-6 * voxels / timing.step, voxels / timing.step / yardstick, bytes, percent(timing.spread).c_str(),
              look.c_str(), percent(guard_share(*solver, timing.step)).c_str(), description.c_str());
  std::fflush(stdout);
}

// a plot of each effect's cost over the share of voxels that have it
void draw(const std::vector<PresenceCost>& costs, const std::string& backend, const std::string& path)
{
  Plot plot;
  plot.title = "An effect costs where it is: " + backend;
  plot.x_label = "voxels (sliding, friction: nodes of a face) that have it [%]";
  plot.y_label = "more than a step without it [%]";
  plot.key = "top left";
  for (const PresenceCost& cost : costs)
  {
    if (cost.share == 0)
      plot.curves.push_back({ name_of(cost.effect), {}, {}, Plot::Style::line_and_points });
    plot.curves.back().x.push_back(100 * cost.share);
    plot.curves.back().y.push_back(100 * cost.step / cost.base);
  }
  write_plot(plot, path);
}

void bench_effects(const BenchOptions& options)
{
  const SolverSettings settings{ backend_from_name(options.backend), options.threads, 0 };
  const double seconds = options.quick ? 1.0 : 4.0;
  // before minutes are spent
  const std::string plot = plot_path(options.plot);
  std::shared_ptr<const Model> model;
  if (!options.source.path.empty())
    model = std::make_shared<const Model>(obtain_model(options.source));
  if (model && model->muscles.empty())
    throw Error(options.source.path + ": has no muscles, so that one is not to be compared with all");
  const auto costs = measure_presence(settings, seconds);
  Table table(
      { "effect", "share [%]", "more a step [us]", "spread [us]", "of the step without [%]", "of its whole [%]" });
  for (std::size_t c = 0; c < costs.size(); ++c)
  {
    const PresenceCost& cost = costs[c];
    // four shares an effect, the last the whole
    const double whole = costs[c - c % 4 + 3].step;
    const auto tenths = [](double x) { return std::round(10 * x) / 10; };
    table.add({ name_of(cost.effect), 100 * cost.share, std::round(1e8 * cost.step) / 100,
                std::round(1e8 * cost.spread) / 100, tenths(100 * cost.step / cost.base),
                tenths(100 * cost.step / whole) });
  }
  std::printf("%s", table.text().c_str());
  if (model)
  {
    const ActivationCost cost = measure_activation(model, settings, seconds);
    std::printf("one muscle active: %.2f us a step; all: %.2f us; spread of the difference %.2f us\n", 1e6 * cost.one,
                1e6 * cost.all, 1e6 * cost.spread);
  }
  // last: nothing that was measured is lost where it cannot be drawn
  if (!plot.empty())
    draw(costs, options.backend, plot);
}

void bench(const BenchOptions& options)
{
  if (options.effects)
    return bench_effects(options);
  if (!options.plot.empty())
    throw WrongUsage("--plot: only with --effects");
  const int threads =
      options.threads > 0 ? options.threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  const double bandwidth = copy_bandwidth(threads);
  const double loop = bare_loop(64, threads, options.quick ? 1.5 : 5.0);
  std::printf("yardsticks   %d threads: copy %.1f GB/s, bare loop of 64^3 voxels %.1f million updates a second\n",
              threads, 1e-9 * bandwidth, 1e-6 * loop);
  std::printf("%-12s %10s  %9s  %9s  %6s  %6s  %7s  %7s  %7s  %s\n", "scene", "voxels", "us/step", "million/s",
              "of bar", "B/vox", "spread", "look", "guard", "backend");
  for (const std::int32_t edge :
       options.quick ? std::vector<std::int32_t>{ 64 } : std::vector<std::int32_t>{ 32, 64, 128 })
    bench_model("block " + std::to_string(edge), std::make_shared<const Model>(dense_block(edge, edge, edge)), options,
                loop);
  if (!options.source.path.empty())
    bench_model("model", std::make_shared<const Model>(obtain_model(options.source)), options, loop);
}

}  // namespace

void add_bench_command(CLI::App& app, Action& action)
{
  auto options = std::make_shared<BenchOptions>();
  CLI::App* command = app.add_subcommand("bench", "time the solver beside what the machine does by itself");
  command->add_option("SCENE_OR_MODEL", options->source.path, "timed too, every muscle at activation 0.75");
  add_scene_options(*command, options->source);
  command->add_option("--backend", options->backend, "auto, reference, cpu or cuda (cpu)")
      ->check(CLI::IsMember({ "auto", "reference", "cpu", "cuda" }));
  command->add_option("--threads", options->threads, "CPU threads; 0: one a core")->check(CLI::Range(0, 1024));
  command->add_flag("--quick", options->quick, "the block of 64^3 voxels alone, a few seconds");
  command->add_flag(
      "--effects", options->effects,
      "what effects cost where a share of the voxels has them; of SCENE_OR_MODEL, one muscle against all");
  command->add_option("--plot", options->plot, "of --effects: FILE.png, and FILE.svg beside it");
  command->callback([options, &action] { action = [options] { bench(*options); }; });
}

}  // namespace frontalis
