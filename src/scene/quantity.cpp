#include "scene/quantity.hpp"

#include "frontalis/error.hpp"
#include "frontalis/physics/number.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iterator>
#include <regex>
#include <string_view>

namespace frontalis
{
namespace
{

struct Unit
{
  Dimension dimension;
  std::string_view name;
  double factor;  ///< value of one unit in SI units
};

constexpr double degree = physics::pi / 180;  // [rad]

constexpr Unit units[] = {
  { Dimension::length, "m", 1 },        { Dimension::length, "cm", 1e-2 },      { Dimension::length, "mm", 1e-3 },
  { Dimension::length, "um", 1e-6 },    { Dimension::length, "in", 0.0254 },    { Dimension::time, "s", 1 },
  { Dimension::time, "ms", 1e-3 },      { Dimension::time, "us", 1e-6 },        { Dimension::rate, "1/s", 1 },
  { Dimension::rate, "Hz", 1 },         { Dimension::pressure, "Pa", 1 },       { Dimension::pressure, "kPa", 1e3 },
  { Dimension::pressure, "MPa", 1e6 },  { Dimension::pressure, "GPa", 1e9 },    { Dimension::density, "kg/m3", 1 },
  { Dimension::density, "g/cm3", 1e3 }, { Dimension::acceleration, "m/s2", 1 }, { Dimension::angle, "deg", degree },
  { Dimension::angle, "rad", 1 },       { Dimension::mass, "kg", 1 },           { Dimension::mass, "g", 1e-3 },
  { Dimension::force, "N", 1 },         { Dimension::force, "mN", 1e-3 },       { Dimension::spring, "N/m", 1 },
  { Dimension::spring, "N/mm", 1e3 },   { Dimension::drag, "Ns/m", 1 },         { Dimension::drag, "kg/s", 1 },
  { Dimension::area, "m2", 1 },         { Dimension::area, "cm2", 1e-4 },       { Dimension::area, "mm2", 1e-6 },
};

/// Returns null if the unit does not exist.
const Unit* find_unit(Dimension dimension, const std::string& name)
{
  const auto same = [&](const Unit& unit) { return unit.dimension == dimension && unit.name == name; };
  const Unit* const found = std::find_if(std::begin(units), std::end(units), same);
  return found == std::end(units) ? nullptr : found;
}

std::string names_of_units(Dimension dimension)
{
  std::string names;
  for (const Unit& unit : units)
    if (unit.dimension == dimension)
      names.append(names.empty() ? "" : ", ").append(unit.name);
  return names;
}

std::string trimmed(const std::string& text)
{
  const char* blanks = " \t\r\n";
  const std::size_t begin = text.find_first_not_of(blanks);
  if (begin == std::string::npos)
    return {};
  return text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

}  // namespace

bool Bound::holds(double value) const
{
  return (lower_allowed ? value >= lower : value > lower) && (upper_allowed ? value <= upper : value < upper);
}

std::string Bound::text() const
{
  std::string text;
  if (std::isfinite(lower))
    text = (lower_allowed ? "at least " : "greater than ") + number_text(lower);
  if (std::isfinite(upper))
    text += (text.empty() ? "" : " and ") + std::string(upper_allowed ? "at most " : "less than ") + number_text(upper);
  return text;
}

double parse_quantity(const std::string& text, Dimension dimension, double length_unit)
{
  const std::string found = trimmed(text);
  const auto refusal = [&](const std::string& fault)
  {
    const std::string names = names_of_units(dimension);
    return Error("'" + found + "' " + fault + "; must be a number" +
                 (names.empty() ? " without a unit" : ", alone or with one of the units " + names));
  };
  // Spellings of infinity and NaN in YAML and C.
  static const std::regex not_finite("[-+]?\\.?(inf|infinity|nan)", std::regex::icase);
  if (std::regex_match(found, not_finite))
    throw refusal("is not finite");

  // std::from_chars does not depend on the locale, but does not accept a leading plus.
  const char* begin = found.data() + (found.size() > 1 && found[0] == '+' && found[1] != '-' ? 1 : 0);
  const char* end = found.data() + found.size();
  double value = 0;
  const std::from_chars_result number = std::from_chars(begin, end, value);
  if (number.ec == std::errc::result_out_of_range)
    throw refusal("is not finite in double precision");
  if (number.ec != std::errc())
    throw refusal("is not a number");

  const std::string unit = trimmed(std::string(number.ptr, end));
  if (unit.empty())
    value *= dimension == Dimension::length ? length_unit : dimension == Dimension::angle ? degree : 1;
  else if (const Unit* known = find_unit(dimension, unit); known != nullptr)
    value *= known->factor;
  else
    throw refusal("has the unknown unit '" + unit + "'");
  if (!std::isfinite(value))
    throw refusal("is not finite");
  return value;
}

double parse_length_unit(const std::string& text)
{
  if (const Unit* unit = find_unit(Dimension::length, text); unit != nullptr)
    return unit->factor;
  throw Error("'" + text + "' is no length unit; allowed are " + names_of_units(Dimension::length));
}

std::string number_text(double value)
{
  std::array<char, 64> buffer{};
  const std::to_chars_result result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return std::string(buffer.data(), result.ptr);
}

}  // namespace frontalis
