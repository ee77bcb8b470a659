#pragma once

#include <hdf5.h>

#include <array>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

namespace frontalis
{

/// Number type of a column in memory and in the file, with the count of numbers an entry.
template <class T, class = void>
struct Hdf5Element
{
  static_assert(std::is_same_v<T, bool>, "no HDF5 type for this element");
  using Number = std::uint8_t;
  static constexpr hsize_t width = 1;
};
template <class T>
struct Hdf5Element<T, std::enable_if_t<std::is_arithmetic_v<T> && !std::is_same_v<T, bool>>>
{
  using Number = T;
  static constexpr hsize_t width = 1;
};
template <class T>
struct Hdf5Element<T, std::enable_if_t<std::is_enum_v<T>>>
{
  using Number = std::underlying_type_t<T>;
  static constexpr hsize_t width = 1;
};
template <class T, std::size_t N>
struct Hdf5Element<std::array<T, N>, void>
{
  using Number = typename Hdf5Element<T>::Number;
  static constexpr hsize_t width = N;
};

/// Type in memory, and in the file (little-endian, so that equal models give equal bytes everywhere).
template <class Number>
struct Hdf5Type;
template <>
struct Hdf5Type<std::uint8_t>
{
  static hid_t memory() { return H5T_NATIVE_UINT8; }
  static hid_t file() { return H5T_STD_U8LE; }
};
template <>
struct Hdf5Type<std::int8_t>
{
  static hid_t memory() { return H5T_NATIVE_INT8; }
  static hid_t file() { return H5T_STD_I8LE; }
};
template <>
struct Hdf5Type<std::int16_t>
{
  static hid_t memory() { return H5T_NATIVE_INT16; }
  static hid_t file() { return H5T_STD_I16LE; }
};
template <>
struct Hdf5Type<std::int32_t>
{
  static hid_t memory() { return H5T_NATIVE_INT32; }
  static hid_t file() { return H5T_STD_I32LE; }
};
template <>
struct Hdf5Type<std::int64_t>
{
  static hid_t memory() { return H5T_NATIVE_INT64; }
  static hid_t file() { return H5T_STD_I64LE; }
};
template <>
struct Hdf5Type<float>
{
  static hid_t memory() { return H5T_NATIVE_FLOAT; }
  static hid_t file() { return H5T_IEEE_F32LE; }
};
template <>
struct Hdf5Type<double>
{
  static hid_t memory() { return H5T_NATIVE_DOUBLE; }
  static hid_t file() { return H5T_IEEE_F64LE; }
};

/// An HDF5 file open for writing or for reading, without times and without HDF5's own messages. Every function throws
/// Error naming the array.
class Hdf5File
{
public:
  static Hdf5File create(const std::string& path);
  /// Throws Error: missing, not HDF5, truncated or damaged.
  static Hdf5File open(const std::string& path);
  Hdf5File(Hdf5File&& other) noexcept;
  Hdf5File& operator=(Hdf5File&&) = delete;
  ~Hdf5File();

  /// Writes everything out; throws Error where that fails (a full disk, say).
  void close();

  void make_group(const std::string& path);
  bool has(const std::string& path) const;

  template <class Number>
  void write(const std::string& path, const Number* data, hsize_t rows, hsize_t width)
  {
    write(path, data, rows, width, Hdf5Type<Number>::memory(), Hdf5Type<Number>::file());
  }

  /// Rows of an array, checking its width.
  hsize_t rows(const std::string& path, hsize_t width) const;
  template <class Number>
  void read(const std::string& path, Number* data, hsize_t rows, hsize_t width) const
  {
    read(path, data, rows, width, Hdf5Type<Number>::memory());
  }

  /// Strings of fixed length, padded with zeros.
  void write_strings(const std::string& path, const std::vector<std::string>& strings);
  std::vector<std::string> read_strings(const std::string& path) const;

  void write_attribute(const std::string& group, const std::string& name, const std::vector<std::int64_t>& values);
  void write_attribute(const std::string& group, const std::string& name, const std::string& value);
  /// The attribute's first number; `otherwise` where there is none.
  std::int64_t attribute(const std::string& group, const std::string& name, std::int64_t otherwise) const;

private:
  explicit Hdf5File(hid_t file) : file_(file) {}
  void write(const std::string& path, const void* data, hsize_t rows, hsize_t width, hid_t memory, hid_t type);
  void read(const std::string& path, void* data, hsize_t rows, hsize_t width, hid_t memory) const;

  hid_t file_ = H5I_INVALID_HID;
};

}  // namespace frontalis
