#pragma once

#include <fstream>
#include <optional>
#include <string>
#include <vector>

namespace frontalis
{

/// The fields of a line between commas, without white space around them.
std::vector<std::string> csv_fields(const std::string& line);

/// The number that the whole text represents, which may be infinite or NaN; empty if the text is not a number.
std::optional<double> number_from(const std::string& text);

/// Reads a table of comma-separated values, whose first line names the columns, row by row.
class CsvReader
{
public:
  /// Reads the header. Throws Error if the file cannot be read or is empty.
  explicit CsvReader(std::string path);

  const std::vector<std::string>& header() const { return header_; }

  /// Reads the next line that is not blank. Returns false at the end of the file. Throws Error if the line does not
  /// have as many fields as the header.
  bool next();

  const std::vector<std::string>& fields() const { return fields_; }

  /// A field of the row as a finite number. Throws Error if the field is not such a number.
  double number(std::size_t column) const;

  /// "FILE:LINE: " of the row, the beginning of messages about it.
  std::string place() const;

private:
  std::string path_;
  std::ifstream file_;
  int line_ = 1;
  std::vector<std::string> header_, fields_;
};

}  // namespace frontalis
