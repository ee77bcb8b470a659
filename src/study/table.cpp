#include "frontalis/study/table.hpp"

#include "frontalis/error.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>

namespace frontalis
{
namespace
{

// the fewest digits that give the same number again
std::string whole(double value)
{
  char text[40];
  return { text, std::to_chars(text, text + sizeof text, value).ptr };
}

std::string shown(const Table::Cell& cell)
{
  if (const auto* number = std::get_if<double>(&cell))
    return readable(*number);
  return std::get<std::string>(cell);
}

// length in characters of UTF-8 text
std::size_t width(const std::string& text)
{
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

std::string csv_cell(const Table::Cell& cell)
{
  if (const auto* number = std::get_if<double>(&cell))
    return std::isnan(*number) ? "" : whole(*number);
  const auto& text = std::get<std::string>(cell);
  if (text.find_first_of(",\"\n\r") == std::string::npos)
    return text;
  std::string quoted = "\"";
  for (const char c : text)
    quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

std::string json_cell(const Table::Cell& cell)
{
  if (const auto* number = std::get_if<double>(&cell))
    return std::isfinite(*number) ? whole(*number) : "null";
  return json_string(std::get<std::string>(cell));
}

}  // namespace

std::string readable(double value, int digits)
{
  if (std::isnan(value))
    return {};
  char text[40];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return text;
}

std::string millimetres(double metres, int digits) { return readable(1e3 * metres, digits) + " mm"; }

std::string json_string(const std::string& text)
{
  std::string out = "\"";
  for (const char c : text)
    if (c == '"' || c == '\\')
      (out += '\\') += c;
    else if (static_cast<unsigned char>(c) < 0x20)
    {
      char escape[8];
      std::snprintf(escape, sizeof escape, "\\u%04x", c);
      out += escape;
    }
    else
      out += c;
  return out + '"';
}

void write_text(const std::string& path, const std::string& text)
{
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file)
    throw Error(path + ": cannot be written: " + std::strerror(errno));
}

void Table::add(std::vector<Cell> row)
{
  if (row.size() != columns_.size())
    throw Error("a row of " + std::to_string(row.size()) + " cells for a table of " + std::to_string(columns_.size()) +
                " columns");
  rows_.push_back(std::move(row));
}

std::string Table::text() const
{
  std::vector<std::size_t> widths;
  for (std::size_t c = 0; c < columns_.size(); ++c)
  {
    std::size_t widest = width(columns_[c]);
    for (const auto& row : rows_)
      widest = std::max(widest, width(shown(row[c])));
    widths.push_back(widest);
  }
  std::string out;
  const auto line = [&](auto&& cell_of)
  {
    std::string padded;
    for (std::size_t c = 0; c < columns_.size(); ++c)
    {
      const std::string cell = cell_of(c);
      padded += cell + std::string(widths[c] - width(cell) + 2, ' ');
    }
    padded.erase(padded.find_last_not_of(' ') + 1);
    out += padded + '\n';
  };
  line([&](std::size_t c) { return columns_[c]; });
  for (const auto& row : rows_)
    line([&](std::size_t c) { return shown(row[c]); });
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
    out += "|";
    for (const auto& cell : row)
      out += " " + shown(cell) + " |";
    out += '\n';
  }
  return out;
}

std::string Table::csv() const
{
  std::string out;
  for (std::size_t c = 0; c < columns_.size(); ++c)
    out += (c ? "," : "") + csv_cell(columns_[c]);
  out += "\r\n";
  for (const auto& row : rows_)
  {
    for (std::size_t c = 0; c < row.size(); ++c)
      out += (c ? "," : "") + csv_cell(row[c]);
    out += "\r\n";
  }
  return out;
}

std::string Table::json() const
{
  std::string out = "[";
  for (std::size_t r = 0; r < rows_.size(); ++r)
  {
    out += r ? ",\n {" : "\n {";
    for (std::size_t c = 0; c < columns_.size(); ++c)
      out += (c ? ", " : "") + json_string(columns_[c]) + ": " + json_cell(rows_[r][c]);
    out += "}";
  }
  return out + "\n]\n";
}

}  // namespace frontalis
