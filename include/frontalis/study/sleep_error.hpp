#pragma once

#include "frontalis/solver/solver.hpp"

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace frontalis
{

/// Muscles that are raised, held, and let go at 1.2 s, both in ramps; 2.5 s in all.
struct SleepHistory
{
  std::map<std::string, double> raised;  ///< activation by muscle, 0..1
  double ramp = 0.3;                     ///< from 0 to 1.2 [s]
};

/// What sleeping saves within a tolerance, and what it errs.
struct SleepError
{
  double tolerance = 0;      ///< [m]
  double seconds = 0;        ///< of the processor
  double awake_seconds = 0;  ///< of those where nothing sleeps
  double error = 0;          ///< farthest that any node is, at any of 150 moments, from where it is then [m]
  double apart = 0;          ///< the same among motions in which nothing sleeps, and that should be one [m]
};

/// Solvers of the backend cpu, one thread each, go through the history side by side. How far the motion is determined
/// at all is told by three more of them in which nothing sleeps: in 64 bits, and with steps that are a thousandth and
/// two thousandths shorter. `go_on` is told how far they are, from 0 to 1, and ends it with false.
/// Throws Error on an unknown muscle, or on tolerances that are no lengths.
std::vector<SleepError> measure_sleep(const std::shared_ptr<const Model>& model, const std::vector<double>& tolerances,
                                      const SleepHistory& history, const std::function<bool(double)>& go_on);

}  // namespace frontalis
