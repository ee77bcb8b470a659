#include "frontalis/error.hpp"
#include "frontalis/study/verification.hpp"

#include <cmath>
#include <filesystem>

namespace frontalis
{
namespace
{

std::string verdict(const Check& check) { return std::isnan(check.bound) ? "shown" : check.passed() ? "pass" : "FAIL"; }

Table check_table(const std::vector<Check>& checks)
{
  Table table({ "check", "unit", "expected", "got", "error", "bound", "" });
  const auto share = [](const Check& check, double value)
  {
    if (std::isnan(value))
      return std::string();
    return check.relative ? readable(100 * value, 3) + " %" : readable(value, 3);
  };
  for (const auto& check : checks)
    table.add({ check.name, check.unit, check.expected, check.found, share(check, check.error),
                share(check, check.bound), verdict(check) });
  return table;
}

}  // namespace

std::string findings_json(const Findings& findings)
{
  Table table({ "case", "check", "unit", "expected", "found", "error", "bound", "relative", "verdict" });
  for (const auto& [name, finding] : findings)
  {
    for (const auto& check : finding.checks)
      table.add({ name, check.name, check.unit, check.expected, check.found, check.error, check.bound,
                  check.relative ? "yes" : "no", verdict(check) });
    if (!finding.skipped.empty())
      table.add({ name, finding.skipped, "", std::nan(""), std::nan(""), std::nan(""), std::nan(""), "", "skipped" });
  }
  return table.json();
}

void write_manual(const Findings& findings, const std::string& path)
{
  const std::filesystem::path manual(path);
  const auto pictures = manual.parent_path() / manual.stem();
  std::error_code failed;
  std::filesystem::create_directories(pictures, failed);
  if (failed)
    throw Error(pictures.string() + ": cannot be made: " + failed.message());
  std::string out =
      "# Verification\n\nWritten by `./dev cli verify --markdown doc/verification.md`; every figure is of one run of "
      "it. A check "
      "passes when its error is within its bound; *shown* are figures that have none. Errors and bounds with % are "
      "relative.\n";
  Table overview({ "case", "checks", "passed" });
  for (const auto& [name, finding] : findings)
  {
    double bounded = 0, passed = 0;
    for (const auto& check : finding.checks)
      if (!std::isnan(check.bound))
      {
        bounded += 1;
        passed += check.passed() ? 1 : 0;
      }
    overview.add({ "[" + finding.title + "](#" + name + ")", bounded, passed });
  }
  out += "\n" + overview.markdown();
  for (const auto& [name, finding] : findings)
  {
    out += "\n## " + finding.title + "\n\n<a id=\"" + name + "\"></a>\n" + finding.text + "\n";
    if (!finding.skipped.empty())
      out += "\nSkipped: " + finding.skipped + "\n";
    if (!finding.checks.empty())
      out += "\n" + check_table(finding.checks).markdown();
    for (const auto& [caption, table] : finding.tables)
      out += "\n" + caption + ":\n\n" + table.markdown();
    for (const auto& [file, plot] : finding.plots)
    {
      write_plot(plot, (pictures / file).string());
      out += "\n![" + plot.title + "](" + manual.stem().string() + "/" + file + ".png)\n";
    }
    if (!finding.remarks.empty())
      out += "\n" + finding.remarks + "\n";
  }
  write_text(path, out);
}

}  // namespace frontalis
