#pragma once

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <variant>
#include <vector>

namespace frontalis
{

/// The results of a study, row by row, as text, markdown, CSV or JSON. Numbers have six digits in text and markdown; in
/// CSV and JSON they have as many as it takes to read the same number again. NaN is an empty cell (JSON: null).
class Table
{
public:
  using Cell = std::variant<std::string, double>;

  /// Names of the columns, with their units, if any: "force [N]".
  explicit Table(std::vector<std::string> columns) : columns_(std::move(columns)) {}

  /// Throws Error if there are not as many cells as columns.
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

/// A number in so many significant digits; empty if it is NaN.
std::string readable(double value, int digits = 6);

/// A length [m] with its unit: "0.2 mm".
std::string millimetres(double metres, int digits = 3);

/// Markdown with its lines broken at spaces to at most so many columns; rows of tables stay whole.
std::string wrapped(const std::string& text, std::size_t columns = 120);

/// JSON indented by one space per level, with a line break at its end.
std::string json_text(const nlohmann::ordered_json& json);

/// Makes a folder and those above it; throws Error naming it.
void make_folder(const std::string& path);

/// Writes a file whole or not at all; throws Error naming it.
void write_text(const std::string& path, const std::string& text);

}  // namespace frontalis
