#include "frontalis/study/stability.hpp"

#include "frontalis/error.hpp"
#include "frontalis/study/step_time.hpp"
#include "study/stability/stability_cases.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace frontalis
{
namespace
{

constexpr const char* line_format = "{:<20} {:<52} {:>18} {:>8} {:>9} {:>9} {:>8}  {}";

}  // namespace

bool Trial::passed() const
{
  return failure.empty() && std::all_of(checks.begin(), checks.end(), [](const Check& c) { return c.passed(); });
}

std::vector<StabilityCase> stability_cases(const std::string& folder)
{
  std::vector<StabilityCase> all;
  for (const auto& family : { hard_materials(), hard_shapes(), hard_muscles(), hard_constraints(), hard_times() })
    for (const auto& [name, play] : family)
    {
      const CaseFile file((std::filesystem::path(folder) / (name + ".yaml")).string());
      const auto run = [file, play = play](const StabilitySettings& settings, Trial& trial)
      {
        play(settings, file, trial);
        if (const auto unused = file.unused(); !unused.empty())
          trial.failure = fmt::format("the case does not use {} of its file", fmt::join(unused, ", "));
      };
      all.push_back({ name, true, file.hard(), file.text(), run });
    }
  return all;
}

Trial run_case(const StabilityCase& hard_case, const StabilitySettings& settings)
{
  Trial trial;
  const double start = wall_seconds();
  try
  {
    hard_case.run(settings, trial);
  }
  catch (const Skipped& skipped)
  {
    trial.skipped = skipped.why;
  }
  catch (const Error& error)
  {
    trial.failure = error.what();
  }
  trial.seconds = wall_seconds() - start;
  return trial;
}

std::string trial_heading()
{
  return fmt::format(line_format, "case", "what is hard", "voxels x steps", "worst J", "energy", "hourglass", "seconds",
                     "verdict");
}

std::string verdict_of(const Trial& trial)
{
  if (!trial.skipped.empty())
    return "skipped: " + trial.skipped;
  if (!trial.failure.empty())
    return "FAILED: " + trial.failure;
  std::string failed;
  for (const Check& check : trial.checks)
    if (!check.passed())
      failed += fmt::format("{}{}: {:.4g} {} and not {:.4g} within {}{}", failed.empty() ? "" : "; ", check.name,
                            check.found, check.unit, check.expected, check.error_text(check.bound),
                            check.relative ? "" : " " + check.unit);
  if (!failed.empty())
    return "FAILED: " + failed;
  if (trial.stopped.empty())
    return trial.rollbacks > 0 ? fmt::format("held; the guard went back {} times", trial.rollbacks) : "held";
  return "stopped with a report: " + trial.stopped;
}

std::string trial_line(const StabilityCase& hard_case, const Trial& trial)
{
  if (!trial.skipped.empty())
    return fmt::format(line_format, hard_case.name, hard_case.hard, "-", "-", "-", "-", "-", verdict_of(trial));
  const auto percent = [](double share) { return std::isnan(share) ? "-" : readable(100 * share, 2) + " %"; };
  return fmt::format(line_format, hard_case.name, hard_case.hard, fmt::format("{} x {}", trial.voxels, trial.steps),
                     std::isfinite(trial.worst_jacobian) ? readable(trial.worst_jacobian, 3) : "-",
                     percent(trial.energy_error), percent(trial.hourglass_share), readable(trial.seconds, 2),
                     verdict_of(trial));
}

}  // namespace frontalis
