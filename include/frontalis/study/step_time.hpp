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

/// Wall or processor seconds per step: one row per turn, one column per solver.
using StepTimes = std::vector<std::vector<double>>;

/// Times the solvers in turn (first, second, ..., first, second, ...) for about `seconds` of wall time in total and at
/// least five turns, so that a disturbance of the machine affects all of them alike. Before that, each solver moves to
/// its controls during 0.1 s of simulated time and comes to rest for another 0.1 s. A solver that needs more than
/// `patience` wall seconds for this (0: `seconds`) keeps the controls that it has reached. `processor_time`: measure
/// the processor time of this process, without other programs; correct only for solvers in the calling thread.
StepTimes time_in_turn(const std::vector<TimedSolver>& solvers, double seconds, bool processor_time = false,
                       double patience = 0);

/// The function with which studies measure time per step; tests replace it.
using StepTimer = std::function<StepTimes(const std::vector<TimedSolver>&)>;
/// time_in_turn() with processor time if works_alone(settings), otherwise with wall time.
StepTimer step_timer(const SolverSettings& settings, double seconds);

/// Time of a steady clock, and processor time that all threads of this process have used [s].
double wall_seconds();
double processor_seconds();

/// Whether a solver with these settings works in the calling thread alone.
bool works_alone(const SolverSettings& settings);

/// A median and half of the interquartile range.
struct Spread
{
  double median = 0;
  double half = 0;
};
Spread spread_of(std::vector<double> values);
/// Spread of the differences between two columns, turn by turn.
Spread spread_of_difference(const StepTimes& times, std::size_t more, std::size_t less);
Spread spread_of(const StepTimes& times, std::size_t column);

/// Bytes per second that large copies read and write with all threads together; the median of several copies. This
/// figure characterises the machine when times of the solver are compared.
double copy_bandwidth(int threads);

}  // namespace frontalis
