#include "frontalis/study/stability.hpp"

#include "frontalis/error.hpp"
#include "frontalis/solver/backend.hpp"
#include "frontalis/study/step_time.hpp"
#include "study/stability/stability_cases.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>

namespace frontalis
{
namespace
{

constexpr const char* line_format = "{:<20} {:<52} {:>18} {:>8} {:>9} {:>9} {:>8}  {}";

double finite_or_none(double value) { return std::isfinite(value) ? value : std::nan(""); }

std::string percent(double share) { return std::isnan(share) ? "" : readable(100 * share, 2); }

// Text of a trial's result: "held", "stopped with a report: ...", "skipped: ..." or "FAILED: ...".
std::string verdict_of(const Trial& trial)
{
  if (!trial.skipped.empty())
    return "skipped: " + trial.skipped;
  if (!trial.failure.empty())
    return "FAILED: " + trial.failure;
  std::string failed;
  for (const Check& check : trial.checks)
    if (!check.passed())
      failed += fmt::format("{}{}: is {:.4g} {}; must be {:.4g} within {}{}", failed.empty() ? "" : "; ", check.name,
                            check.found, check.unit, check.expected, check.error_text(check.bound),
                            check.relative ? "" : " " + check.unit);
  if (!failed.empty())
    return "FAILED: " + failed;
  if (trial.stopped.empty())
    return trial.rollbacks == 0   ? "held"
           : trial.rollbacks == 1 ? "held; guard: once"
                                  : fmt::format("held; guard: {} times", trial.rollbacks);
  return "stopped with a report: " + trial.stopped;
}

}  // namespace

bool Trial::passed() const
{
  return failure.empty() && std::all_of(checks.begin(), checks.end(), [](const Check& c) { return c.passed(); });
}

std::vector<StabilityCase> stability_cases(const std::string& folder)
{
  std::vector<StabilityCase> all;
  for (const auto& family : { hard_materials(), hard_shapes(), hard_muscles(), hard_constraints(), hard_contacts(),
                              hard_slits(), hard_faces(), hard_times() })
    for (const auto& [name, play] : family)
    {
      const CaseFile file((std::filesystem::path(folder) / (name + ".yaml")).string());
      const auto run = [file, play = play](const StabilitySettings& settings, Trial& trial)
      {
        CaseRun now{ file, settings, trial };
        play(now);
        // a motion that was stopped has not come to all of its file
        if (const auto unused = now.unused(); !unused.empty() && trial.stopped.empty())
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
  // If the backend refuses what the case needs, the case is skipped.
  catch (const BackendUnavailable& error)
  {
    trial.skipped = error.what();
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

std::string trials_json(const Trials& trials)
{
  Table table({ "case", "hard", "voxels", "steps", "worst_jacobian", "energy_error", "hourglass_share", "rollbacks",
                "verdict", "seconds" });
  for (const auto& [hard_case, trial] : trials)
    table.add({ hard_case.name, hard_case.hard, static_cast<double>(trial.voxels), static_cast<double>(trial.steps),
                finite_or_none(trial.worst_jacobian), trial.energy_error, trial.hourglass_share,
                static_cast<double>(trial.rollbacks), verdict_of(trial), trial.seconds });
  return table.json();
}

std::string trials_markdown(const Trials& trials)
{
  Table overview(
      { "case", "what is hard", "voxels", "steps", "worst J", "energy [%]", "hourglass [%]", "seconds", "verdict" });
  for (const auto& [hard_case, trial] : trials)
  {
    const bool ran = trial.skipped.empty();
    overview.add({ "[" + hard_case.name + "](#" + hard_case.name + ")", hard_case.hard,
                   ran ? fmt::to_string(trial.voxels) : "", ran ? fmt::to_string(trial.steps) : "",
                   readable(finite_or_none(trial.worst_jacobian), 3), percent(trial.energy_error),
                   percent(trial.hourglass_share), readable(trial.seconds, 2),
                   trial.stopped.empty() ? verdict_of(trial) : "stopped with a report" });
  }
  return overview.markdown();
}

void write_stability(const Trials& trials, const std::string& folder)
{
  const std::filesystem::path pictures = std::filesystem::path(folder) / "stability";
  make_folder(pictures.string());
  std::string out =
      "# Hard cases\n\n"
      "This page lists motions that explicit finite element codes tend to fail at, and how frontalis copes with each. "
      "A case must hold, or be stopped with a report and the last good state. It passes when all its checks do and "
      "every energy, volume ratio and displacement stays finite.\n\n"
      "A guard watches every motion, in these cases and in use. When it finds a fault, it returns to the latest good "
      "state and takes shorter steps for a while; in the tables, *guard: once* says that it did so once. After three "
      "tries it stops the motion with a report that names the voxel and the likely cause ([an "
      "example](#held_neighbours)).\n\n"
      "    ./dev cli stability --all --mesh-dir DIR --markdown FOLDER    # writes this page\n\n"
      "`--models DIR` writes the model of each motion. Each case has a file in test/stability with its description, "
      "sizes, times and bounds.\n\n"
      "*Worst J* is the smallest volume ratio of a voxel, *energy* the imbalance of the energy ledger, and "
      "*hourglass* the energy of hourglass modes, both over the largest term of the ledger.\n";
  out += "\n" + trials_markdown(trials);
  for (const auto& [hard_case, trial] : trials)
  {
    out += "\n## " + hard_case.name + "\n\n" + hard_case.text + "\n";
    if (!trial.skipped.empty())
      out += "\nSkipped: " + trial.skipped + "\n";
    if (!trial.stopped.empty())
      out += "\nThe report: *" + trial.stopped + "*\n";
    if (!trial.checks.empty())
    {
      Table checks({ "check", "unit", "expected", "got", "bound", "" });
      for (const Check& check : trial.checks)
        checks.add(
            { check.name, check.unit, check.expected, check.found, check.error_text(check.bound), check.verdict() });
      out += "\n" + checks.markdown();
    }
    out += write_plots(trial.plots, pictures.string());
  }
  write_text((std::filesystem::path(folder) / "stability.md").string(), wrapped(out));
}

}  // namespace frontalis
