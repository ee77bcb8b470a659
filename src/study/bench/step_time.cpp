#include "frontalis/study/step_time.hpp"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <ctime>
#include <functional>
#include <thread>
#include <vector>

namespace frontalis
{
namespace
{

// Seconds per step over about `steps` steps. A GPU solver queues steps; reading its skin waits for them.
double time_steps(Solver& solver, const Controls& controls, double steps, bool processor_time)
{
  SkinState skin;
  solver.skin(skin);
  const auto before = solver.profile().steps;
  const auto now = [&] { return processor_time ? processor_seconds() : wall_seconds(); };
  const double start = now();
  solver.advance(steps * solver.time_step(), controls);
  solver.skin(skin);
  return (now() - start) / static_cast<double>(std::max<std::int64_t>(1, solver.profile().steps - before));
}

// Number of steps that take about `seconds`. Tries ever more steps, because a coarse clock may show 0 for a few.
double steps_for(const TimedSolver& timed, double seconds, bool processor_time)
{
  for (double steps = 64;; steps *= 2)
  {
    const double taken = steps * time_steps(*timed.solver, timed.controls, steps, processor_time);
    if (taken >= seconds / 2)
      return std::max(32.0, steps * seconds / taken);
  }
}

// Moves a solver to its controls and lets it come to rest. After `seconds` of wall time, stops at the controls reached.
void approach_controls(TimedSolver& timed, double seconds)
{
  Solver& solver = *timed.solver;
  constexpr double ramp = 0.1;  // simulated time [s]
  const Controls from = solver.controls();
  const double start = wall_seconds();
  for (double time = 0; time < 2 * ramp && wall_seconds() - start < seconds;)
  {
    const double slice = 64 * solver.time_step();
    time += slice;
    solver.advance(slice, interpolate(from, timed.controls, std::min(1.0, time / ramp)));
  }
  timed.controls = solver.controls();
}

void on_threads(int threads, const std::function<void(int)>& task)
{
  std::vector<std::thread> team;
  for (int t = 1; t < threads; ++t)
    team.emplace_back(task, t);
  task(0);
  for (auto& thread : team)
    thread.join();
}

}  // namespace

double wall_seconds()
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double processor_seconds()
{
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

StepTimes time_in_turn(const std::vector<TimedSolver>& wanted, double seconds, bool processor_time, double patience)
{
  constexpr double burst = 0.02;  // wall time of each solver in each turn [s]
  std::vector<TimedSolver> solvers = wanted;
  std::vector<double> steps;
  for (TimedSolver& timed : solvers)
  {
    approach_controls(timed, patience > 0 ? patience : seconds);
    steps.push_back(steps_for(timed, burst, processor_time));
  }
  StepTimes turns;
  const double start = wall_seconds();
  while (turns.size() < 5 || wall_seconds() - start < seconds)
  {
    turns.emplace_back();
    for (std::size_t s = 0; s < solvers.size(); ++s)
      turns.back().push_back(time_steps(*solvers[s].solver, solvers[s].controls, steps[s], processor_time));
  }
  return turns;
}

StepTimer step_timer(const SolverSettings& settings, double seconds)
{
  return [seconds, alone = works_alone(settings)](const std::vector<TimedSolver>& solvers)
  { return time_in_turn(solvers, seconds, alone); };
}

bool works_alone(const SolverSettings& settings)
{
  return settings.backend == "reference" || (settings.backend == "cpu" && settings.threads == 1);
}

Spread spread_of(std::vector<double> values)
{
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return { values[n / 2], 0.5 * (values[3 * n / 4] - values[n / 4]) };
}

Spread spread_of_difference(const StepTimes& times, std::size_t more, std::size_t less)
{
  std::vector<double> differences;
  for (const std::vector<double>& turn : times)
    differences.push_back(turn[more] - turn[less]);
  return spread_of(std::move(differences));
}

Spread spread_of(const StepTimes& times, std::size_t column)
{
  std::vector<double> values;
  for (const std::vector<double>& turn : times)
    values.push_back(turn[column]);
  return spread_of(std::move(values));
}

double copy_bandwidth(int threads)
{
  const std::size_t bytes = std::size_t(64) << 20;
  std::vector<std::vector<char>> from(static_cast<std::size_t>(threads)), to(from.size());
  const auto begin = [&](int t)
  {
    from[static_cast<std::size_t>(t)].assign(bytes, 1);
    to[static_cast<std::size_t>(t)].assign(bytes, 0);
  };
  const auto copy = [&](int t)
  { std::memcpy(to[static_cast<std::size_t>(t)].data(), from[static_cast<std::size_t>(t)].data(), bytes); };
  on_threads(threads, begin);
  std::vector<double> rates;
  for (int repetition = 0; repetition < 7; ++repetition)
  {
    const double start = wall_seconds();
    on_threads(threads, copy);
    rates.push_back(2.0 * static_cast<double>(bytes) * threads / (wall_seconds() - start));
  }
  return spread_of(rates).median;
}

}  // namespace frontalis
