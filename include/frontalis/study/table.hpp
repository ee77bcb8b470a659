#pragma once

#include <nlohmann/json_fwd.hpp>

#include <functional>
#include <string>
#include <variant>
#include <vector>

namespace frontalis
{

/// One millimetre [m], the unit of lengths in the tables of studies.
constexpr double millimetre = 1e-3;

/// The results of a study as text, markdown, CSV or JSON. Numbers have six significant digits in text and markdown. In
/// CSV and JSON they have so many digits that a reader gets exactly the same numbers. NaN becomes an empty cell, or
/// null in JSON.
class Table
{
public:
  using Cell = std::variant<std::string, double>;

  /// Names of the columns, with a unit where there is one: "force [N]".
  explicit Table(std::vector<std::string> columns) : columns_(std::move(columns)) {}

  /// Throws Error if there are not as many cells as columns.
  void add(std::vector<Cell> row);

  std::string text() const;      ///< columns aligned by spaces
  std::string markdown() const;  ///< a pipe table
  std::string csv() const;       ///< RFC 4180
  std::string json() const;      ///< an array of objects

private:
  std::vector<std::string> columns_;
  std::vector<std::vector<Cell>> rows_;
};

/// A computed figure, the expected value and the largest error that passes.
struct Check
{
  std::string name;
  std::string unit;
  double expected = 0;
  double found = 0;
  double bound = 0;  ///< bound of error(); NaN: no bound, the figure is only shown
  bool relative = true;

  double error() const;  ///< |found - expected|, divided by |expected| if relative
  bool passed() const { return !(error() > bound) && error() == error(); }
  std::string verdict() const;                 ///< "pass", "FAIL", or "shown" if there is no bound
  std::string error_text(double value) const;  ///< an error or a bound, in percent if relative; NaN: empty
};

/// The checks of a case; each function adds one.
struct Checks : std::vector<Check>
{
  void relative(const std::string& name, const std::string& unit, double expected, double found, double bound)
  {
    push_back({ name, unit, expected, found, bound, true });
  }
  void absolute(const std::string& name, const std::string& unit, double expected, double found, double bound)
  {
    push_back({ name, unit, expected, found, bound, false });
  }
};

/// The heading of check_line(), and the line of one check. `name`: name of the case.
std::string check_heading();
std::string check_line(const std::string& name, const Check& check);

/// Slope of log y against log x by least squares. This is the order of convergence if y is an error and x the voxel
/// edge.
double slope(const std::vector<double>& x, const std::vector<double>& y);

/// The zero of an increasing function between `low` and `high`, by bisection.
double zero_between(double low, double high, const std::function<double(double)>& increasing, int halvings = 60);

/// A number with `digits` significant digits; empty if it is NaN.
std::string readable(double value, int digits = 6);

/// A length [m] with its unit: "0.2 mm".
std::string millimetres(double metres, int digits = 3);

/// Markdown with lines broken at spaces after at most `columns` characters; rows of tables stay whole.
std::string wrapped(const std::string& text, std::size_t columns = 120);

/// JSON indented by one space per level, with a line break at its end.
std::string json_text(const nlohmann::ordered_json& json);

/// Creates a folder and its parents; throws Error with its path.
void make_folder(const std::string& path);
/// Removes those files of a folder whose whole names match a regular expression.
void remove_files(const std::string& folder, const std::string& names);

/// Writes a file completely or not at all; throws Error with its path.
void write_text(const std::string& path, const std::string& text);

}  // namespace frontalis
