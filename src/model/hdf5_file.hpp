#pragma once

#include <hdf5.h>

#include <array>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

namespace frontalis
{

/// Number type of an array's entries, and how many numbers an entry has.
template <class T, class = void>
struct Hdf5Element
{
  using Number = T;
  static constexpr hsize_t width = 1;
};
template <>
struct Hdf5Element<bool> : Hdf5Element<std::uint8_t>
{
};
template <class T>
struct Hdf5Element<T, std::enable_if_t<std::is_enum_v<T>>> : Hdf5Element<std::underlying_type_t<T>>
{
};
template <class T, std::size_t N>
struct Hdf5Element<std::array<T, N>> : Hdf5Element<T>
{
  static constexpr hsize_t width = N;
};

/// Types of numbers in memory and in the file (little-endian, so that equal models give equal bytes everywhere).
struct Hdf5Types
{
  hid_t memory, file;
};
inline Hdf5Types types_of(std::uint8_t) { return { H5T_NATIVE_UINT8, H5T_STD_U8LE }; }
inline Hdf5Types types_of(std::int16_t) { return { H5T_NATIVE_INT16, H5T_STD_I16LE }; }
inline Hdf5Types types_of(std::int32_t) { return { H5T_NATIVE_INT32, H5T_STD_I32LE }; }
inline Hdf5Types types_of(std::int64_t) { return { H5T_NATIVE_INT64, H5T_STD_I64LE }; }
inline Hdf5Types types_of(float) { return { H5T_NATIVE_FLOAT, H5T_IEEE_F32LE }; }
inline Hdf5Types types_of(double) { return { H5T_NATIVE_DOUBLE, H5T_IEEE_F64LE }; }

/// An HDF5 file open for writing or for reading, without time stamps and without HDF5's own error messages. Every
/// function throws Error naming the array. Strings have a fixed length and are padded with zeros.
class Hdf5File
{
public:
  static Hdf5File create(const std::string& path);
  /// Throws Error if the file is missing, not HDF5, truncated or damaged.
  static Hdf5File open(const std::string& path);
  Hdf5File(const Hdf5File&) = delete;
  Hdf5File& operator=(const Hdf5File&) = delete;
  ~Hdf5File();

  /// Writes all data to the file. Throws Error if that fails, for instance because the disk is full.
  void close();

  void make_group(const std::string& path);
  bool has(const std::string& path) const { return H5Lexists(file_, path.c_str(), H5P_DEFAULT) > 0; }

  /// Writes an array, and makes its group if it is missing. Entries are numbers, enums or arrays of numbers.
  template <class T>
  void write(const std::string& path, const std::vector<T>& entries)
  {
    using Element = Hdf5Element<T>;
    const Hdf5Types types = types_of(typename Element::Number{});
    write(path, entries.data(), entries.size(), Element::width, types.memory, types.file);
  }
  void write(const std::string& path, const std::vector<std::string>& strings);

  template <class T>
  void read(const std::string& path, std::vector<T>& entries) const
  {
    using Element = Hdf5Element<T>;
    entries.resize(rows(path, Element::width));
    read(path, entries.data(), entries.size(), types_of(typename Element::Number{}).memory);
  }
  void read(const std::string& path, std::vector<std::string>& strings) const;

  void write_attribute(const std::string& group, const std::string& name, const std::vector<std::int64_t>& values);
  void write_attribute(const std::string& group, const std::string& name, const std::string& value);
  /// Returns the value of the attribute, or `otherwise` if it does not exist.
  std::int64_t attribute(const std::string& group, const std::string& name, std::int64_t otherwise) const;

private:
  explicit Hdf5File(hid_t file) : file_(file) {}
  void write(const std::string& path, const void* data, hsize_t rows, hsize_t width, hid_t memory, hid_t type);
  /// Number of rows of an array. Throws Error if the rows do not have this width.
  hsize_t rows(const std::string& path, hsize_t width) const;
  void read(const std::string& path, void* data, hsize_t rows, hid_t memory) const;
  void write_attribute(const std::string& group, const std::string& name, hid_t space, hid_t memory, hid_t type,
                       const void* data);

  hid_t file_ = H5I_INVALID_HID;
};

}  // namespace frontalis
