#pragma once

#include <string>
#include <variant>
#include <vector>

namespace frontalis
{

/// What a study found, row by row: written as text, markdown, CSV or JSON. Numbers keep six digits in text and markdown
/// and are written whole in CSV and JSON; NaN is an empty cell (JSON: null).
class Table
{
public:
  using Cell = std::variant<std::string, double>;

  /// Columns with their names, units included where they have some: "force [N]".
  explicit Table(std::vector<std::string> columns) : columns_(std::move(columns)) {}

  /// Throws Error where the number of cells is not that of the columns.
  void add(std::vector<Cell> row);

  const std::vector<std::string>& columns() const { return columns_; }
  const std::vector<std::vector<Cell>>& rows() const { return rows_; }

  std::string text() const;      ///< columns aligned by spaces
  std::string markdown() const;  ///< a pipe table
  std::string csv() const;       ///< RFC 4180
  std::string json() const;      ///< an array of objects

private:
  std::vector<std::string> columns_;
  std::vector<std::vector<Cell>> rows_;
};

/// A number for readers: six significant digits; empty where it is NaN.
std::string readable(double value, int digits = 6);

/// A length [m] with its unit: "0.2 mm".
std::string millimetres(double metres, int digits = 3);

/// Text as a JSON string with its quotes.
std::string json_string(const std::string& text);

/// Writes a whole file; throws Error naming it.
void write_text(const std::string& path, const std::string& text);

}  // namespace frontalis
