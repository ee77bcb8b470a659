#pragma once

#include <optional>
#include <string>
#include <vector>

namespace frontalis
{

/// The fields of a line between commas, without white space around them.
std::vector<std::string> fields_of(const std::string& line);

/// The number that the whole text represents, finite or not; nothing if it is not a number.
std::optional<double> number_from(const std::string& text);

}  // namespace frontalis
