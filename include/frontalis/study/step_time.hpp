#pragma once

#include "frontalis/solver/solver.hpp"

#include <vector>

namespace frontalis
{

struct TimedSolver
{
  Solver* solver;
  Controls controls;
};

/// Seconds that one step of each solver takes, measured in turn (first, second, ..., first, second, ...) for about so
/// many wall seconds in all, so that what disturbs the machine disturbs them alike. Controls are reached before that,
/// over a tenth of a simulated second, and what they set in motion has as long to calm down; where that would take each
/// solver more than `patience` wall seconds (0: `seconds`), it stays at the controls that it has reached. One row a
/// turn, at least five. `processor_time`: what the process had of a processor, and not the wall's clock; right for one
/// thread alone (see is_alone).
std::vector<std::vector<double>> time_in_turn(const std::vector<TimedSolver>& solvers, double seconds,
                                              bool processor_time = false, double patience = 0);

/// Of a clock that only goes on; what this process has had of all processors [s].
double wall_seconds();
double processor_seconds();

/// Whether a solver of these settings works in the calling thread alone, so that time that others take from it can be
/// told.
bool is_alone(const SolverSettings& settings);

/// Median, and half of what lies between the quartiles.
struct Spread
{
  double median = 0;
  double half = 0;
};
Spread spread_of(std::vector<double> values);

}  // namespace frontalis
