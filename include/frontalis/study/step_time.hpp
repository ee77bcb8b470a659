#pragma once

#include "frontalis/solver/solver.hpp"

#include <vector>

namespace frontalis
{

/// Seconds that one step of each solver takes, measured in turn (first, second, ..., first, second, ...) for about so
/// many wall seconds in all, so that what disturbs the machine disturbs them alike. Controls are reached before that,
/// over a tenth of a simulated second or as many wall seconds. One row a turn, at least five.
std::vector<std::vector<double>> time_in_turn(const std::vector<Solver*>& solvers, const Controls& controls,
                                              double seconds);

/// Median, and half of what lies between the quartiles.
struct Spread
{
  double median = 0;
  double half = 0;
};
Spread spread_of(std::vector<double> values);

}  // namespace frontalis
