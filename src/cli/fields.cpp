#include "cli/fields.hpp"

#include <boost/algorithm/string.hpp>

#include <charconv>

namespace frontalis
{

std::vector<std::string> fields_of(const std::string& line)
{
  std::vector<std::string> fields;
  boost::split(fields, line, [](char c) { return c == ','; });
  for (std::string& field : fields)
    boost::trim(field);
  return fields;
}

std::optional<double> number_from(const std::string& text)
{
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() ? std::optional<double>(value) : std::nullopt;
}

}  // namespace frontalis
