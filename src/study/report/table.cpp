#include "frontalis/study/table.hpp"

#include "frontalis/error.hpp"

#include <fmt/core.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>

namespace frontalis
{
namespace
{

namespace fs = std::filesystem;

constexpr const char* check_format = "{:<17} {:<44} {:>12} {:>12} {:<6} {:>10} {:>8}  {}";

std::string shown(const Table::Cell& cell)
{
  const auto* number = std::get_if<double>(&cell);
  return number != nullptr ? readable(*number) : std::get<std::string>(cell);
}

// Number of characters of UTF-8 text.
std::size_t width(const std::string& text)
{
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

std::string csv_cell(const Table::Cell& cell)
{
  if (const auto* number = std::get_if<double>(&cell))
    return std::isnan(*number) ? "" : fmt::format("{}", *number);
  const auto& text = std::get<std::string>(cell);
  if (text.find_first_of(",\"\n\r") == std::string::npos)
    return text;
  return '"' + std::regex_replace(text, std::regex("\""), "\"\"") + '"';
}

}  // namespace

double Check::error() const { return std::abs(found - expected) / (relative ? std::abs(expected) : 1); }

std::string Check::verdict() const { return !passed() ? "FAIL" : std::isnan(bound) ? "shown" : "pass"; }

std::string Check::error_text(double value) const
{
  if (std::isnan(value))
    return {};
  return relative ? readable(100 * value, 3) + " %" : readable(value, 3);
}

std::string check_heading()
{
  return fmt::format(check_format, "case", "check", "expected", "got", "unit", "error", "bound", "");
}

std::string check_line(const std::string& name, const Check& check)
{
  const auto or_dash = [](const std::string& text) { return text.empty() ? "-" : text; };
  return fmt::format(check_format, name, check.name, readable(check.expected), readable(check.found), check.unit,
                     or_dash(check.error_text(check.error())), or_dash(check.error_text(check.bound)), check.verdict());
}

double slope(const std::vector<double>& x, const std::vector<double>& y)
{
  double mx = 0, my = 0, xx = 0, xy = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
  {
    mx += std::log(x[i]) / static_cast<double>(x.size());
    my += std::log(y[i]) / static_cast<double>(x.size());
  }
  for (std::size_t i = 0; i < x.size(); ++i)
  {
    xx += (std::log(x[i]) - mx) * (std::log(x[i]) - mx);
    xy += (std::log(x[i]) - mx) * (std::log(y[i]) - my);
  }
  return xy / xx;
}

double zero_between(double low, double high, const std::function<double(double)>& increasing, int halvings)
{
  for (int halving = 0; halving < halvings; ++halving)
    (increasing(0.5 * (low + high)) < 0 ? low : high) = 0.5 * (low + high);
  return 0.5 * (low + high);
}

std::string readable(double value, int digits)
{
  return std::isnan(value) ? "" : fmt::format("{:.{}g}", value, digits);
}

std::string millimetres(double metres, int digits) { return readable(1e3 * metres, digits) + " mm"; }

std::string wrapped(const std::string& text, std::size_t columns)
{
  std::string out;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
  {
    // Rows of tables, headings, pictures and code must stay whole. Continuation lines of a list item are indented.
    const bool is_whole = line.find_first_of("|#!< ") == 0, is_entry = line.rfind("- ", 0) == 0;
    std::size_t used = 0;
    std::istringstream words(is_whole ? "" : line);
    for (std::string word; words >> word;)
    {
      const bool breaks = used > 0 && used + 1 + width(word) > columns;
      const std::string before = used == 0 ? "" : !breaks ? " " : is_entry ? "\n  " : "\n";
      out += before + word;
      used = (breaks ? before.size() - 1 : used + before.size()) + width(word);
    }
    out += used == 0 ? line + '\n' : "\n";
  }
  return out;
}

std::string json_text(const nlohmann::ordered_json& json)
{
  // Names from files may be invalid UTF-8, which must not cause an exception.
  return json.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + '\n';
}

void make_folder(const std::string& path)
{
  std::error_code failed;
  fs::create_directories(path, failed);
  if (failed)
    throw Error(path + ": cannot be created: " + failed.message());
}

void remove_files(const std::string& folder, const std::string& names)
{
  const std::regex pattern(names);
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.is_regular_file() && std::regex_match(entry.path().filename().string(), pattern))
      found.push_back(entry.path());
  for (const fs::path& file : found)
    fs::remove(file);
}

void write_text(const std::string& path, const std::string& text)
{
  std::error_code failed;
  // Unlike a regular file, a device or a pipe cannot be replaced by renaming.
  const bool is_replaceable = !fs::exists(path, failed) || fs::is_regular_file(path, failed);
  const std::string place = is_replaceable ? path + ".partial-" + std::to_string(::getpid()) : path;
  std::ofstream file(place, std::ios::binary);
  file << text;
  file.close();
  failed = file ? std::error_code() : std::error_code(errno, std::generic_category());
  if (is_replaceable && !failed)
    fs::rename(place, path, failed);
  if (!failed)
    return;
  std::error_code ignored;
  if (is_replaceable)
    fs::remove(place, ignored);
  throw Error(path + ": cannot be written: " + failed.message());
}

void Table::add(std::vector<Cell> row)
{
  if (row.size() != columns_.size())
    throw Error(fmt::format("a row has {} cells; its table has {} columns", row.size(), columns_.size()));
  rows_.push_back(std::move(row));
}

std::string Table::text() const
{
  std::vector<std::vector<std::string>> lines{ columns_ };
  for (const auto& row : rows_)
    std::transform(row.begin(), row.end(), std::back_inserter(lines.emplace_back()), shown);
  std::vector<std::size_t> widths(columns_.size(), 0);
  for (const auto& line : lines)
    for (std::size_t c = 0; c < line.size(); ++c)
      widths[c] = std::max(widths[c], width(line[c]));
  std::string out;
  for (const auto& line : lines)
  {
    for (std::size_t c = 0; c < line.size(); ++c)
      out += line[c] + std::string(widths[c] - width(line[c]) + 2, ' ');
    out.erase(out.find_last_not_of(' ') + 1);
    out += '\n';
  }
  return out;
}

std::string Table::markdown() const
{
  std::string out = "|", rule = "|";
  for (const auto& column : columns_)
  {
    out += " " + column + " |";
    rule += "---|";
  }
  out += '\n' + rule + '\n';
  for (const auto& row : rows_)
  {
    for (const auto& cell : row)
      out += (&cell == row.data() ? "| " : " ") + shown(cell) + " |";
    out += '\n';
  }
  return out;
}

std::string Table::csv() const
{
  std::string out;
  const auto line = [&](const auto& cells)
  {
    for (std::size_t c = 0; c < cells.size(); ++c)
      out += (c > 0 ? "," : "") + csv_cell(cells[c]);
    out += "\r\n";
  };
  line(columns_);
  for (const auto& row : rows_)
    line(row);
  return out;
}

std::string Table::json() const
{
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const auto& row : rows_)
  {
    auto& object = rows.emplace_back(nlohmann::ordered_json::object());
    for (std::size_t c = 0; c < columns_.size(); ++c)
    {
      const auto* number = std::get_if<double>(&row[c]);
      if (number == nullptr)
        object[columns_[c]] = std::get<std::string>(row[c]);
      else if (*number == std::floor(*number) && std::abs(*number) < 1e15)
        object[columns_[c]] = static_cast<std::int64_t>(*number);  // 5 instead of 5.0
      else
        object[columns_[c]] = *number;
    }
  }
  return json_text(rows);
}

}  // namespace frontalis
