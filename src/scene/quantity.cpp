#include "scene/quantity.hpp"

#include "frontalis/error.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <vector>

namespace frontalis
{
namespace
{

struct Unit
{
  const char* name;
  double factor;  ///< in SI units
};

const std::vector<Unit>& units_of(Dimension dimension)
{
  static const std::vector<Unit> none;
  static const std::vector<Unit> length{ { "m", 1 }, { "cm", 1e-2 }, { "mm", 1e-3 }, { "um", 1e-6 }, { "in", 0.0254 } };
  static const std::vector<Unit> time{ { "s", 1 }, { "ms", 1e-3 }, { "us", 1e-6 } };
  static const std::vector<Unit> rate{ { "1/s", 1 }, { "Hz", 1 } };
  static const std::vector<Unit> pressure{ { "Pa", 1 }, { "kPa", 1e3 }, { "MPa", 1e6 }, { "GPa", 1e9 } };
  static const std::vector<Unit> density{ { "kg/m3", 1 }, { "g/cm3", 1e3 } };
  static const std::vector<Unit> acceleration{ { "m/s2", 1 } };
  switch (dimension)
  {
    case Dimension::length:
      return length;
    case Dimension::time:
      return time;
    case Dimension::rate:
      return rate;
    case Dimension::pressure:
      return pressure;
    case Dimension::density:
      return density;
    case Dimension::acceleration:
      return acceleration;
    case Dimension::number:
      break;
  }
  return none;
}

std::string names_of(const std::vector<Unit>& units)
{
  std::string names;
  for (const Unit& unit : units)
    names += (names.empty() ? "" : ", ") + std::string(unit.name);
  return names;
}

std::string expected(Dimension dimension)
{
  const std::vector<Unit>& units = units_of(dimension);
  return units.empty() ? "a number without a unit" : "a number, alone or with one of the units " + names_of(units);
}

// whether a text is one of the words of YAML and C for infinity and not-a-number
bool names_not_finite(std::string text)
{
  if (!text.empty() && (text[0] == '-' || text[0] == '+'))
    text.erase(0, 1);
  if (!text.empty() && text[0] == '.')
    text.erase(0, 1);
  for (char& letter : text)
    if (letter >= 'A' && letter <= 'Z')
      letter = static_cast<char>(letter - 'A' + 'a');
  return text == "inf" || text == "infinity" || text == "nan";
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
  if (names_not_finite(found))
    throw Error("'" + found + "' is not finite; must be " + expected(dimension));

  // std::from_chars does not depend on the locale, but does not accept a leading plus
  const char* begin = found.data() + (found.size() > 1 && found[0] == '+' && found[1] != '-' ? 1 : 0);
  const char* end = found.data() + found.size();
  double value = 0;
  const std::from_chars_result number = std::from_chars(begin, end, value);
  if (number.ec == std::errc::result_out_of_range)
    throw Error("'" + found + "' is not finite in double precision; must be " + expected(dimension));
  if (number.ec != std::errc())
    throw Error("'" + found + "' is not a number; must be " + expected(dimension));

  const std::string unit = trimmed(std::string(number.ptr, end));
  if (unit.empty())
    value *= dimension == Dimension::length ? length_unit : 1;
  else
  {
    bool known = false;
    for (const Unit& candidate : units_of(dimension))
      if (unit == candidate.name)
      {
        value *= candidate.factor;
        known = true;
        break;
      }
    if (!known)
      throw Error("'" + found + "' has the unknown unit '" + unit + "'; must be " + expected(dimension));
  }
  if (!std::isfinite(value))
    throw Error("'" + found + "' is not finite; must be " + expected(dimension));
  return value;
}

double parse_length_unit(const std::string& text)
{
  for (const Unit& unit : units_of(Dimension::length))
    if (text == unit.name)
      return unit.factor;
  throw Error("'" + text + "' is no length unit; allowed are " + names_of(units_of(Dimension::length)));
}

std::string number_text(double value)
{
  std::array<char, 64> buffer{};
  const std::to_chars_result result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return std::string(buffer.data(), result.ptr);
}

}  // namespace frontalis
