#include "frontalis/study/check.hpp"

#include <fmt/core.h>

#include <cmath>
#include <utility>

namespace frontalis
{
namespace
{

constexpr const char* line_format = "{:<17} {:<44} {:>12} {:>12} {:<6} {:>10} {:>8}  {}";

Check check_of(std::string name, std::string unit, double expected, double found, double bound, bool relative)
{
  Check check{ std::move(name), std::move(unit), expected, found, std::abs(found - expected), bound, relative };
  if (relative)
    check.error /= std::abs(expected);
  return check;
}

}  // namespace

std::string Check::verdict() const { return std::isnan(bound) ? "shown" : passed() ? "pass" : "FAIL"; }

std::string Check::error_text(double value) const
{
  if (std::isnan(value))
    return {};
  return relative ? readable(100 * value, 3) + " %" : readable(value, 3);
}

Check relative_check(std::string name, std::string unit, double expected, double found, double bound)
{
  return check_of(std::move(name), std::move(unit), expected, found, bound, true);
}

Check absolute_check(std::string name, std::string unit, double expected, double found, double bound)
{
  return check_of(std::move(name), std::move(unit), expected, found, bound, false);
}

std::string check_heading()
{
  return fmt::format(line_format, "case", "check", "expected", "got", "unit", "error", "bound", "");
}

std::string check_line(const std::string& name, const Check& check)
{
  const auto or_dash = [](const std::string& text) { return text.empty() ? "-" : text; };
  return fmt::format(line_format, name, check.name, readable(check.expected), readable(check.found), check.unit,
                     or_dash(check.error_text(check.error)), or_dash(check.error_text(check.bound)), check.verdict());
}

Table check_table(const Checks& checks)
{
  Table table({ "check", "unit", "expected", "got", "error", "bound", "" });
  for (const Check& check : checks)
    table.add({ check.name, check.unit, check.expected, check.found, check.error_text(check.error),
                check.error_text(check.bound), check.verdict() });
  return table;
}

double slope(const std::vector<double>& x, const std::vector<double>& y)
{
  double mx = 0, my = 0, xx = 0, xy = 0;
  const auto n = static_cast<double>(x.size());
  for (std::size_t i = 0; i < x.size(); ++i)
  {
    mx += std::log(x[i]) / n;
    my += std::log(y[i]) / n;
  }
  for (std::size_t i = 0; i < x.size(); ++i)
  {
    xx += (std::log(x[i]) - mx) * (std::log(x[i]) - mx);
    xy += (std::log(x[i]) - mx) * (std::log(y[i]) - my);
  }
  return xy / xx;
}

}  // namespace frontalis
