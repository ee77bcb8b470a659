#pragma once

#include <optional>
#include <string>
#include <vector>

namespace frontalis
{

/// The fields of a line between commas, without white space around them.
std::vector<std::string> fields_of(const std::string& line);

/// The number that a text is as a whole, finite or not; nothing where it is none.
std::optional<double> number_from(const std::string& text);

}  // namespace frontalis
