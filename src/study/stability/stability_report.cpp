#include "study/stability/stability_cases.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace frontalis
{
namespace
{

double finite_or_none(double value) { return std::isfinite(value) ? value : std::nan(""); }

std::string percent(double share) { return std::isnan(share) ? "" : readable(100 * share, 2); }

}  // namespace

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
      "# Hard cases\n\nMotions that explicit codes fail at. Each must hold, or be stopped with a report and the last "
      "good "
      "state. A case passes when all its checks do and every energy, volume ratio and displacement stays finite.\n\n"
      "*Worst J* is the smallest volume ratio of a voxel, *energy* the imbalance of the energy ledger, and *hourglass* "
      "the energy of hourglass modes, both over the largest term of the ledger. Each case has a file in test/stability "
      "with its description, sizes, times and bounds. This document is written by `./dev cli stability --all "
      "--mesh-dir "
      "DIR --markdown doc`, and all figures but those of a GPU are from one run of it. `--models DIR` writes the model "
      "of "
      "each motion.\n";
  out += "\n" + trials_markdown(trials);
  // a text about runs on other machines, written by hand
  std::ifstream elsewhere(pictures / "elsewhere.md");
  if (elsewhere)
    out += "\n" + std::string(std::istreambuf_iterator<char>(elsewhere), {});
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
    for (const auto& [file, plot] : trial.plots)
    {
      write_plot(plot, (pictures / file).string());
      out += "\n![" + plot.title + "](stability/" + file + ".png)\n";
    }
  }
  write_text((std::filesystem::path(folder) / "stability.md").string(), wrapped(out));
}

}  // namespace frontalis
