#pragma once

#include <limits>
#include <string>

namespace frontalis
{

/// Physical dimension of a number in a scene file: the allowed units; then the unit of a number without one.
enum class Dimension
{
  number,       ///< without a unit
  length,       ///< m, cm, mm, um, in; the scene's length unit
  time,         ///< s, ms, us; s
  rate,         ///< 1/s, Hz; 1/s
  pressure,     ///< Pa, kPa, MPa, GPa; Pa
  density,      ///< kg/m3, g/cm3; kg/m3
  acceleration  ///< m/s2; m/s2
};

/// Range that a number must lie in.
struct Bound
{
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  bool lower_allowed = true;
  bool upper_allowed = true;

  bool holds(double value) const;
  std::string text() const;  ///< "greater than 0", "at least 0 and at most 1"
};

constexpr Bound any_number{};
constexpr Bound positive{ 0, std::numeric_limits<double>::infinity(), false, true };
constexpr Bound not_negative{ 0 };
constexpr Bound at_least_one{ 1 };
constexpr Bound proportion{ 0, 1 };

/// Parses a finite number with an optional unit and returns it in SI units. `length_unit` [m] applies to lengths
/// without a unit. Throws Error with what was found and what is allowed.
double parse_quantity(const std::string& text, Dimension dimension, double length_unit);

/// Metres per length unit. Throws Error naming the units that exist.
double parse_length_unit(const std::string& text);

/// Shortest text that reads back as the same number, whatever the locale.
std::string number_text(double value);

}  // namespace frontalis
