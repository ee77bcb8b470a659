#pragma once

#include "frontalis/solver/solver.hpp"
#include "frontalis/study/plot.hpp"
#include "frontalis/study/table.hpp"

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace frontalis
{

/// The result of a StabilityCase.
struct Trial
{
  std::int64_t voxels = 0;                                          ///< number of voxels of the case's largest model
  std::int64_t steps = 0;                                           ///< number of time steps of all motions
  double worst_jacobian = std::numeric_limits<double>::infinity();  ///< smallest J = det F
  /// Largest imbalance and largest hourglass energy, both divided by the ledger's largest term; NaN: no ledger.
  double energy_error = std::numeric_limits<double>::quiet_NaN();
  double hourglass_share = std::numeric_limits<double>::quiet_NaN();
  std::int64_t rollbacks = 0;  ///< how often the guard returned to an earlier state
  Checks checks;               ///< checks, all of which must pass
  std::string stopped;         ///< the guard's report if it stopped the motion, which is not a failure
  std::string failure;         ///< an error that ended the case or a fault of its file; empty: none
  std::string skipped;         ///< why the case was not run; empty: it ran
  Plots plots;
  double seconds = 0;  ///< wall time

  bool passed() const;  ///< also true for a skipped case
};

/// Thrown by a case that cannot run here, with the reason.
struct Skipped
{
  std::string why;
};

struct StabilitySettings
{
  Backend backend = "cpu";
  bool long_runs = false;  ///< run every case in full length, even if it has a short form
  /// Returns the model of the scene NAME.yaml, of config or for a case; throws Skipped if there is none.
  std::function<std::shared_ptr<const Model>(const std::string& name)> scene;
  /// Called with the model of each motion before it begins.
  std::function<void(const Model&)> model = [](const Model&) {};
  /// Called with the completed fraction of a motion, 0..1; may throw to end the run.
  std::function<void(double done)> watch = [](double) {};
};

/// One or more motions at which explicit codes tend to fail.
struct StabilityCase
{
  std::string name;
  bool quick;        ///< part of the short set
  std::string hard;  ///< what makes the case hard, in a few words
  std::string text;  ///< markdown: the motion and the requirements on it
  std::function<void(const StabilitySettings&, Trial&)> run;
};

/// All cases, in the order of the document. Descriptions, sizes, times and bounds are read from FOLDER/NAME.yaml.
/// Throws Error if a file is missing or invalid.
std::vector<StabilityCase> stability_cases(const std::string& folder);

/// Runs a case. An Error that the case throws becomes the `failure` of the trial.
Trial run_case(const StabilityCase& hard_case, const StabilitySettings& settings);

/// The heading of trial_line(), and the line of one case.
std::string trial_heading();
std::string trial_line(const StabilityCase& hard_case, const Trial& trial);

/// Write trials with their cases as JSON, as a markdown table, and as a document FOLDER/stability.md with plots in
/// FOLDER/stability/. write_stability() throws Error if a file cannot be written or gnuplot is missing.
using Trials = std::vector<std::pair<StabilityCase, Trial>>;
std::string trials_json(const Trials& trials);
std::string trials_markdown(const Trials& trials);
void write_stability(const Trials& trials, const std::string& folder);

}  // namespace frontalis
