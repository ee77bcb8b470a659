#pragma once

#include "frontalis/solver/solver.hpp"
#include "frontalis/study/plot.hpp"
#include "frontalis/study/table.hpp"

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace frontalis
{

/// One figure beside what it should be.
struct Check
{
  std::string name;
  std::string unit;
  double expected = 0;
  double found = 0;
  double error = 0;  ///< |found - expected|, over |expected| where relative
  double bound = 0;  ///< largest error that passes; NaN: none is set, the figure is shown as it is
  bool relative = true;

  bool passed() const { return !(error > bound) && error == error; }
};

Check relative_check(std::string name, std::string unit, double expected, double found, double bound);
Check absolute_check(std::string name, std::string unit, double expected, double found, double bound);

/// What a verification case found, and the words for the manual.
struct Finding
{
  std::string title;
  std::string text;  ///< markdown: what is compared with what, and where the expected figures come from
  std::vector<Check> checks;
  std::vector<std::pair<std::string, Table>> tables;  ///< caption, table
  std::vector<std::pair<std::string, Plot>> plots;    ///< file name without extension, plot; its title is the caption
  std::string remarks;                                ///< markdown, after the figures
  std::string skipped;                                ///< why nothing was checked; empty: it was
};

struct VerificationSettings
{
  Backend backend = "cpu";  ///< of the motions; figures of single elements come from the reference
};

struct VerificationCase
{
  std::string name;
  bool quick;  ///< takes at most some seconds: part of the quick share
  std::function<Finding(const VerificationSettings&)> run;
};

/// All cases, in the manual's order.
std::vector<VerificationCase> verification_cases();

/// One line a check, as `frontalis verify` prints them; `name` is the case's.
std::string check_line(const std::string& name, const Check& check);

/// Findings by name of their case, as JSON and as the manual: FOLDER/verification.md with its plots beside it in
/// FOLDER/verification/. Throws Error where a file cannot be written or gnuplot is missing.
using Findings = std::vector<std::pair<std::string, Finding>>;
std::string findings_json(const Findings& findings);
void write_manual(const Findings& findings, const std::string& path);

}  // namespace frontalis
