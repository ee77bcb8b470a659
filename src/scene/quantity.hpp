#pragma once

#include <limits>
#include <string>

namespace frontalis
{

/// Physical dimension of a number in a scene file, with the allowed units and the default unit.
enum class Dimension
{
  number,        ///< without a unit
  length,        ///< m, cm, mm, um, in; default: the scene's length unit
  area,          ///< m2, cm2, mm2; default: m2
  time,          ///< s, ms, us; default: s
  rate,          ///< 1/s, Hz; default: 1/s
  pressure,      ///< Pa, kPa, MPa, GPa; default: Pa
  density,       ///< kg/m3, g/cm3; default: kg/m3
  acceleration,  ///< m/s2; default: m/s2
  angle,         ///< deg, rad; default: deg, as on the command line; parsed to rad
  mass,          ///< kg, g; default: kg
  force,         ///< N, mN; default: N
  spring,        ///< N/m, N/mm; default: N/m
  drag           ///< force divided by velocity: Ns/m, kg/s; default: Ns/m
};

/// Range of allowed numbers.
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

/// Length unit [m] of a name such as "mm". Throws Error naming the units that exist.
double parse_length_unit(const std::string& text);

/// Shortest text that reads back as the same number, independent of the locale.
std::string number_text(double value);

}  // namespace frontalis
