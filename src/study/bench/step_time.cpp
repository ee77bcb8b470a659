#include "frontalis/study/step_time.hpp"

#include <algorithm>
#include <chrono>
#include <ctime>

namespace frontalis
{
namespace
{

// seconds a step, over about so many steps; a GPU solver queues some, so that its skin is waited for
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

// to where it has come of the way to its controls after so many wall seconds
void bring(TimedSolver& timed, double seconds)
{
  Solver& solver = *timed.solver;
  constexpr double ramp = 0.1;
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

std::vector<std::vector<double>> time_in_turn(const std::vector<TimedSolver>& wanted, double seconds,
                                              bool processor_time, double patience)
{
  constexpr double burst = 0.02;  // [s] of each solver in a turn
  std::vector<TimedSolver> solvers = wanted;
  std::vector<double> steps;
  for (TimedSolver& timed : solvers)
  {
    bring(timed, patience > 0 ? patience : seconds);
    steps.push_back(std::max(32.0, burst / time_steps(*timed.solver, timed.controls, 64, processor_time)));
  }
  std::vector<std::vector<double>> turns;
  const double start = wall_seconds();
  while (turns.size() < 5 || wall_seconds() - start < seconds)
  {
    turns.emplace_back();
    for (std::size_t s = 0; s < solvers.size(); ++s)
      turns.back().push_back(time_steps(*solvers[s].solver, solvers[s].controls, steps[s], processor_time));
  }
  return turns;
}

bool is_alone(const SolverSettings& settings)
{
  return settings.backend == "reference" || (settings.backend == "cpu" && settings.threads == 1);
}

Spread spread_of(std::vector<double> values)
{
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return { values[n / 2], 0.5 * (values[3 * n / 4] - values[n / 4]) };
}

}  // namespace frontalis
