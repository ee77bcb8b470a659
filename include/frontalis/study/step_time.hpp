#pragma once

#include "frontalis/solver/solver.hpp"

#include <functional>
#include <vector>

namespace frontalis
{

struct TimedSolver
{
  Solver* solver;
  Controls controls;
};

/// Seconds that one step of each solver takes; one row per turn.
using StepTimes = std::vector<std::vector<double>>;

/// Times one step of each solver in turn (first, second, ..., first, second, ...) for about so many wall seconds in
/// all, at least five turns, so that a disturbance of the machine meets all of them alike. Before that it brings the
/// solvers to their controls over a tenth of a simulated second and lets them calm down for as long; a solver that
/// would take more than `patience` wall seconds for it (0: `seconds`) stays at the controls that it has reached.
/// `processor_time`: counts the time that the process had of a processor instead of wall time, so that other programs
/// do not count; right only where the solver works in the calling thread (see works_alone).
StepTimes time_in_turn(const std::vector<TimedSolver>& solvers, double seconds, bool processor_time = false,
                       double patience = 0);

/// What studies of costs get their times from, so that tests can give them a timer of their own.
using StepTimer = std::function<StepTimes(const std::vector<TimedSolver>&)>;
/// time_in_turn() on the clock that suits solvers of these settings.
StepTimer step_timer(const SolverSettings& settings, double seconds);

/// Time of a steady clock, and what this process has had of all processors [s].
double wall_seconds();
double processor_seconds();

/// Whether a solver of these settings works in the calling thread alone.
bool works_alone(const SolverSettings& settings);

/// Median, and half of the distance between the quartiles.
struct Spread
{
  double median = 0;
  double half = 0;
};
Spread spread_of(std::vector<double> values);
/// Of the differences between two columns, turn by turn.
Spread spread_of_difference(const StepTimes& times, std::size_t more, std::size_t less);
/// Of one column.
Spread spread_of(const StepTimes& times, std::size_t column);

// Yardsticks of the machine, to compare figures of the solver with in the same run.

/// Bytes per second that large copies read and write, all threads together; median of several.
double copy_bandwidth(int threads);

/// Element updates per second of a bare loop: a dense block of edge^3 equal neo-Hookean voxels on plain arrays,
/// hourglass stiffness and central differences, no muscles, constraints or checks, on the widest instruction set;
/// median of several.
double bare_loop(int edge, int threads, double seconds);

}  // namespace frontalis
