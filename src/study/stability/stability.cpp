#include "frontalis/study/stability.hpp"

#include "frontalis/error.hpp"
#include "study/stability/stability_cases.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>

namespace frontalis
{

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
        for (const std::string& key : file.idle())
          trial.failure += (trial.failure.empty() ? "" : "; ") + key + " of its file is of no use";
      };
      all.push_back({ name, true, file.hard(), file.text(), run });
    }
  return all;
}

Trial run_case(const StabilityCase& hard_case, const StabilitySettings& settings)
{
  Trial trial;
  const auto start = std::chrono::steady_clock::now();
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
  trial.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return trial;
}

std::string trial_heading()
{
  char line[300];
  std::snprintf(line, sizeof line, "%-20s %-52s %18s %8s %9s %9s %8s  %s", "case", "what is hard", "voxels x steps",
                "worst J", "energy", "hourglass", "seconds", "verdict");
  return line;
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
      failed += (failed.empty() ? "" : "; ") + check.name + ": " + readable(check.found, 4) + " " + check.unit +
                " and not " + readable(check.expected, 4) + " within " +
                readable(check.relative ? 100 * check.bound : check.bound, 3) +
                (check.relative ? " %" : " " + check.unit);
  if (!failed.empty())
    return "FAILED: " + failed;
  if (trial.stopped.empty())
    return trial.rollbacks > 0 ? "held; the guard went back " + std::to_string(trial.rollbacks) + " times" : "held";
  return "stopped with a report: " + trial.stopped;
}

std::string trial_line(const StabilityCase& hard_case, const Trial& trial)
{
  const auto percent = [](double share) { return std::isnan(share) ? "-" : readable(100 * share, 2) + " %"; };
  const bool ran = trial.skipped.empty();
  char line[300];
  std::snprintf(line, sizeof line, "%-20s %-52s %18s %8s %9s %9s %8s  ", hard_case.name.c_str(), hard_case.hard.c_str(),
                ran ? (std::to_string(trial.voxels) + " x " + std::to_string(trial.steps)).c_str() : "-",
                ran && std::isfinite(trial.worst_jacobian) ? readable(trial.worst_jacobian, 3).c_str() : "-",
                ran ? percent(trial.energy_error).c_str() : "-", ran ? percent(trial.hourglass_share).c_str() : "-",
                ran ? readable(trial.seconds, 2).c_str() : "-");
  return line + verdict_of(trial);
}

}  // namespace frontalis
