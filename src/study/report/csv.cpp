#include "frontalis/study/csv.hpp"

#include "frontalis/error.hpp"

#include <boost/algorithm/string.hpp>
#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace frontalis
{

std::vector<std::string> csv_fields(const std::string& line)
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

CsvReader::CsvReader(std::string path) : path_(std::move(path)), file_(path_)
{
  std::string line;
  if (!std::getline(file_, line))
    throw Error(path_ + ": cannot be read, or is empty");
  // Spreadsheets begin a file with a byte-order mark.
  if (line.rfind("\xef\xbb\xbf", 0) == 0)
    line.erase(0, 3);
  header_ = csv_fields(line);
}

bool CsvReader::next()
{
  for (std::string line; std::getline(file_, line);)
  {
    ++line_;
    if (line.find_first_not_of(" \t\r") == std::string::npos)
      continue;
    fields_ = csv_fields(line);
    if (fields_.size() != header_.size())
      throw Error(fmt::format("{}found {} fields; the header has {}", place(), fields_.size(), header_.size()));
    return true;
  }
  return false;
}

double CsvReader::number(std::size_t column) const
{
  const double value = number_from(fields_[column]).value_or(NAN);
  if (!std::isfinite(value))
    throw Error(place() + "found '" + fields_[column] + "'; must be a number");
  return value;
}

std::string CsvReader::place() const { return fmt::format("{}:{}: ", path_, line_); }

}  // namespace frontalis
