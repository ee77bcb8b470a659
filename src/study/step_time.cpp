#include "frontalis/study/step_time.hpp"

#include <algorithm>
#include <chrono>

namespace frontalis
{
namespace
{

using Clock = std::chrono::steady_clock;

double since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

// seconds a step, over about so many steps; a GPU solver queues some, so that its skin is waited for
double time_steps(Solver& solver, const Controls& controls, double steps)
{
  SkinState skin;
  solver.skin(skin);
  const auto before = solver.profile().steps;
  const auto start = Clock::now();
  solver.advance(steps * solver.time_step(), controls);
  solver.skin(skin);
  return since(start) / static_cast<double>(std::max<std::int64_t>(1, solver.profile().steps - before));
}

// controls are reached over a tenth of a second, and what they set in motion has as long to calm down, unless that
// takes longer than so many wall seconds
void bring_to(Solver& solver, const Controls& controls, double seconds)
{
  constexpr double ramp = 0.1;
  const Controls from = solver.controls();
  const auto start = Clock::now();
  for (double time = 0; time < 2 * ramp && since(start) < seconds;)
  {
    const double slice = 64 * solver.time_step();
    time += slice;
    solver.advance(slice, interpolate(from, controls, std::min(1.0, time / ramp)));
  }
}

}  // namespace

std::vector<std::vector<double>> time_in_turn(const std::vector<Solver*>& solvers, const Controls& controls,
                                              double seconds)
{
  constexpr double burst = 0.02;  // [s] of each solver in a turn
  std::vector<double> steps;
  for (Solver* const solver : solvers)
  {
    bring_to(*solver, controls, seconds);
    steps.push_back(std::max(32.0, burst / time_steps(*solver, controls, 64)));
  }
  std::vector<std::vector<double>> turns;
  const auto start = Clock::now();
  while (turns.size() < 5 || since(start) < seconds)
  {
    turns.emplace_back();
    for (std::size_t s = 0; s < solvers.size(); ++s)
      turns.back().push_back(time_steps(*solvers[s], controls, steps[s]));
  }
  return turns;
}

Spread spread_of(std::vector<double> values)
{
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return { values[n / 2], 0.5 * (values[3 * n / 4] - values[n / 4]) };
}

}  // namespace frontalis
