#pragma once

#include "frontalis/study/table.hpp"

#include <string>
#include <vector>

namespace frontalis
{

/// A computed figure beside the expected one.
struct Check
{
  std::string name;
  std::string unit;
  double expected = 0;
  double found = 0;
  double error = 0;  ///< |found - expected|, divided by |expected| where relative
  double bound = 0;  ///< largest error that passes; NaN: there is none, and the figure is only shown
  bool relative = true;

  bool passed() const { return !(error > bound) && error == error; }
  std::string verdict() const;                 ///< "pass", "FAIL", or "shown" if there is no bound
  std::string error_text(double value) const;  ///< an error or a bound: in percent where relative; NaN: empty
};

Check relative_check(std::string name, std::string unit, double expected, double found, double bound);
Check absolute_check(std::string name, std::string unit, double expected, double found, double bound);

/// The checks of a case, to which each function adds one.
struct Checks : std::vector<Check>
{
  void relative(const std::string& name, const std::string& unit, double expected, double found, double bound)
  {
    push_back(relative_check(name, unit, expected, found, bound));
  }
  void absolute(const std::string& name, const std::string& unit, double expected, double found, double bound)
  {
    push_back(absolute_check(name, unit, expected, found, bound));
  }
};

/// The heading of check_line(), and one line per check; `name` is that of its case.
std::string check_heading();
std::string check_line(const std::string& name, const Check& check);

/// One row per check, for the documents.
Table check_table(const Checks& checks);

/// Slope of log y against log x by least squares: the order at which an error y falls with a voxel edge x.
double slope(const std::vector<double>& x, const std::vector<double>& y);

}  // namespace frontalis
