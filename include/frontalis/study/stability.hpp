#pragma once

#include "frontalis/study/verification.hpp"

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace frontalis
{

/// What a hard case did.
struct Trial
{
  std::int64_t voxels = 0;                                          ///< of its largest model
  std::int64_t steps = 0;                                           ///< of all its motions
  double worst_jacobian = std::numeric_limits<double>::infinity();  ///< smallest J = det F that was seen
  /// Largest imbalance of the energy ledger, and of hourglass energy, over the ledger's largest term; NaN: none kept.
  double energy_error = std::numeric_limits<double>::quiet_NaN();
  double hourglass_share = std::numeric_limits<double>::quiet_NaN();
  std::int64_t rollbacks = 0;  ///< of the guard
  std::vector<Check> checks;   ///< what it has to fulfil
  std::string stopped;         ///< the solver's report where it stopped the motion, and was right to
  std::string failure;         ///< what ended the case before its end; empty: nothing did
  std::string skipped;         ///< why it was not run; empty: it was
  std::vector<std::pair<std::string, Plot>> plots;  ///< file name without extension, plot
  double seconds = 0;                               ///< of wall time

  bool passed() const;  ///< or skipped
};

/// Thrown by a case that cannot run here, with the reason.
struct Skipped
{
  std::string why;
};

struct StabilitySettings
{
  Backend backend = "cpu";
  bool long_runs = false;  ///< in full length, where a case has a shorter form
  /// Model of a scene of this name (those in config, real_head among them); throws Skipped where there is none.
  std::function<std::shared_ptr<const Model>(const std::string& name)> scene;
  /// Told of each motion's model before it begins.
  std::function<void(const Model&)> model = [](const Model&) {};
  /// Told how far a motion is, 0..1; may throw to end it all.
  std::function<void(double done)> watch = [](double) {};
};

/// A motion that explicit codes fail at.
struct StabilityCase
{
  std::string name;
  bool quick;        ///< part of the short set
  std::string hard;  ///< what is hard about it, in a few words
  std::string text;  ///< markdown: the motion, what it has to fulfil, and what fails without which measure
  std::function<void(const StabilitySettings&, Trial&)> run;
};

/// All cases, in the document's order; their words, sizes, times and bounds are read from FOLDER/NAME.yaml. Throws
/// Error where one is missing or wrong.
std::vector<StabilityCase> stability_cases(const std::string& folder);

/// Runs one; what it throws, but what `watch` throws, becomes a failure.
Trial run_case(const StabilityCase& hard_case, const StabilitySettings& settings);

/// One line a case, as `frontalis stability` prints them, and their heading.
std::string trial_heading();
std::string trial_line(const StabilityCase& hard_case, const Trial& trial);

/// Trials with their cases, as JSON, as a table in markdown, and as FOLDER/stability.md with its plots in
/// FOLDER/stability/, where what is said of runs elsewhere is taken from (elsewhere.md). Throws Error where a file
/// cannot be written or gnuplot is missing.
using Trials = std::vector<std::pair<StabilityCase, Trial>>;
std::string trials_json(const Trials& trials);
std::string trials_markdown(const Trials& trials);
void write_stability(const Trials& trials, const std::string& folder);

}  // namespace frontalis
