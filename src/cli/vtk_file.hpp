#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace frontalis
{

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "the bytes of numbers are written as they are in memory");

/// Appends the bytes of a list of numbers.
template <class List>
void append_bytes(std::string& bytes, const List& numbers)
{
  bytes.append(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof numbers[0]);
}

/// A file in VTK's XML format, which ParaView reads. The arrays of numbers come after the XML, each after its size in
/// bytes.
class VtkFile
{
public:
  /// `type`: of the data set, such as PolyData; `sizes`: attributes of its only piece.
  VtkFile(std::string type, std::string sizes);

  /// Adds a list of names to the data set.
  void add_names(const std::string& name, const std::vector<std::string>& names);
  /// Begins an element of the piece, such as Points, and ends the one before.
  void begin(const std::string& element, const std::string& attributes = {});
  /// Adds an array to the element.
  template <class Number>
  void add(const std::string& name, const std::vector<Number>& numbers)
  {
    add(name, type_of(Number()), 1, numbers);
  }
  template <class Number, std::size_t size>
  void add(const std::string& name, const std::vector<std::array<Number, size>>& numbers)
  {
    add(name, type_of(Number()), size, numbers);
  }
  /// Adds the corners of cells, one cell after the other, and where those of each cell end.
  template <std::size_t size>
  void add_corners(const std::vector<std::array<std::int32_t, size>>& cells)
  {
    add("connectivity", type_of(std::int32_t()), 1, cells);
    std::vector<std::int32_t> ends(cells.size());
    for (std::size_t c = 0; c < ends.size(); ++c)
      ends[c] = static_cast<std::int32_t>(size * (c + 1));
    add("offsets", ends);
  }
  /// Ends the file and returns it.
  std::string text() const;

private:
  static const char* type_of(float) { return "Float32"; }
  static const char* type_of(std::int32_t) { return "Int32"; }
  static const char* type_of(std::uint8_t) { return "UInt8"; }

  template <class List>
  void add(const std::string& name, const char* type, std::size_t components, const List& numbers)
  {
    declare(name, type, components);
    append_bytes(bytes_, std::array<std::uint64_t, 1>{ { numbers.size() * sizeof numbers[0] } });
    append_bytes(bytes_, numbers);
  }
  void declare(const std::string& name, const char* type, std::size_t components);

  std::string type_, sizes_, element_, names_, xml_, bytes_;
};

}  // namespace frontalis
