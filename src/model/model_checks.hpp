#pragma once

#include "frontalis/error.hpp"
#include "frontalis/model/model.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace frontalis
{
/// Checks of a model's arrays. Each throws an Error that begins with the name of the array.
namespace checks
{

template <class... Values>
[[noreturn]] void fail(const std::string& array, fmt::format_string<Values...> found, Values&&... values)
{
  throw Error(array + ": " + fmt::format(found, std::forward<Values>(values)...));
}

inline void check_length(const std::string& array, std::size_t found, std::size_t right, const std::string& of)
{
  if (found != right)
    fail(array, "has {} entries; must have {}, one per {}", found, right, of);
}

inline void check_finite(const std::string& array, std::size_t at, double value)
{
  if (!std::isfinite(value))
    fail(array, "entry {} is {}; it must be finite", at, value);
}

inline void check_positive(const std::string& array, std::size_t at, double value)
{
  check_finite(array, at, value);
  if (!(value > 0))
    fail(array, "entry {} is {}; it must be above 0", at, value);
}

inline void check_not_negative(const std::string& array, const std::string& what, double value)
{
  if (!(value >= 0) || !std::isfinite(value))
    fail(array, "{} is {}; it must be finite and at least 0", what, value);
}

inline void check_proportion(const std::string& array, std::size_t at, double value)
{
  check_finite(array, at, value);
  if (value < 0 || value > 1.0001)
    fail(array, "entry {} is {}; proportions lie between 0 and 1", at, value);
}

/// Returns a check that an index is at least `lowest` and below `count`.
inline auto index_below(std::size_t count, std::ptrdiff_t lowest = 0)
{
  return [=](const std::string& array, std::size_t at, std::ptrdiff_t index)
  {
    const std::ptrdiff_t end = static_cast<std::ptrdiff_t>(count);
    if (index < lowest || index >= end)
      fail(array, "entry {} is {}; indices run from {} to {}", at, index, lowest, end - 1);
  };
}

/// Checks an entry that is a number or an array of numbers.
template <class Check, class Entry>
void check_entry(const std::string& array, std::size_t at, const Check& check, const Entry& entry)
{
  if constexpr (std::is_arithmetic_v<Entry>)
    check(array, at, entry);
  else
    for (const auto number : entry)
      check(array, at, number);
}

/// Checks all entries of an array or, if a field is named, that field of each entry.
template <class Check, class Entry, class... Field>
void check_each(const std::string& array, const Check& check, const std::vector<Entry>& entries, Field... field)
{
  for (std::size_t at = 0; at < entries.size(); ++at)
    check_entry(array, at, check, (entries[at].*....*field));
}

void check_mesh(const std::string& array, const TriangleMesh& mesh);
void check_binding(const std::string& array, const Binding& binding, std::size_t points, std::size_t voxels);
void check_field(const std::string& array, const SampledField& field);

}  // namespace checks
}  // namespace frontalis
