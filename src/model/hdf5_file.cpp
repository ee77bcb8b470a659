#include "model/hdf5_file.hpp"

#include "frontalis/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <utility>

namespace frontalis
{
namespace
{

/// Closes an HDF5 identifier at the end of its scope.
class Handle
{
public:
  using Close = herr_t (*)(hid_t);
  Handle(hid_t id, Close close, const std::string& what) : id_(id), close_(close)
  {
    if (id_ < 0)
      throw Error("HDF5: cannot " + what);
  }
  ~Handle() { close_(id_); }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  operator hid_t() const { return id_; }

private:
  hid_t id_;
  Close close_;
};

void silence() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

/// To be called after failures: at its end, HDF5 waits in vain for other threads that still have errors.
void forget_errors() { H5Eclear2(H5E_DEFAULT); }

/// Creation properties that store no time stamps, so that equal models give equal bytes.
hid_t timeless(hid_t kind)
{
  const hid_t list = H5Pcreate(kind);
  H5Pset_obj_track_times(list, 0);
  return list;
}

hid_t string_type(std::size_t length)
{
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, std::max<std::size_t>(length, 1));
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  return type;
}

}  // namespace

Hdf5File Hdf5File::create(const std::string& path)
{
  silence();
  const Handle list(timeless(H5P_FILE_CREATE), H5Pclose, "make a property list");
  const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, list, H5P_DEFAULT);
  if (file < 0)
  {
    forget_errors();
    throw Error("cannot create the file; the folder must exist and be writable");
  }
  return Hdf5File(file);
}

Hdf5File Hdf5File::open(const std::string& path)
{
  silence();
  std::error_code code;
  if (!std::filesystem::exists(path, code))
    throw Error("there is no such file");
  if (std::filesystem::is_directory(path, code))
    throw Error("is a folder; must be a model file");
  if (!std::ifstream(path))
    throw Error("cannot be read; check its permissions");
  if (H5Fis_hdf5(path.c_str()) <= 0)
    throw Error("is not an HDF5 file; must be a model written by 'frontalis bake'");
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (file < 0)
  {
    forget_errors();
    throw Error("is truncated or damaged; bake it again");
  }
  return Hdf5File(file);
}

Hdf5File::~Hdf5File()
{
  if (file_ >= 0)
    H5Fclose(file_);
  forget_errors();
}

void Hdf5File::close()
{
  const bool flushed = H5Fflush(file_, H5F_SCOPE_GLOBAL) >= 0;
  const bool closed = H5Fclose(std::exchange(file_, H5I_INVALID_HID)) >= 0;
  if (!flushed || !closed)
    throw Error("cannot be written whole; is the disk full?");
}

void Hdf5File::make_group(const std::string& path)
{
  const Handle list(timeless(H5P_GROUP_CREATE), H5Pclose, "make a property list");
  const Handle group(H5Gcreate2(file_, path.c_str(), H5P_DEFAULT, list, H5P_DEFAULT), H5Gclose, "make group " + path);
}

void Hdf5File::write(const std::string& path, const void* data, hsize_t rows, hsize_t width, hid_t memory, hid_t type)
{
  if (const std::string group = path.substr(0, path.rfind('/')); !has(group))
    make_group(group);
  const hsize_t shape[2] = { rows, width };
  const Handle space(H5Screate_simple(width == 1 ? 1 : 2, shape, nullptr), H5Sclose, "make the shape of " + path);
  const Handle list(timeless(H5P_DATASET_CREATE), H5Pclose, "make a property list");
  if (rows > 0)
  {
    // Checksums need chunks; those of equal size hold little more than the array.
    constexpr hsize_t most_bytes = 1 << 20;
    const hsize_t chunks = 1 + rows * width * H5Tget_size(type) / most_bytes;
    const hsize_t chunk[2] = { (rows + chunks - 1) / chunks, width };
    if (H5Pset_chunk(list, width == 1 ? 1 : 2, chunk) < 0 || H5Pset_fletcher32(list) < 0)
      throw Error("HDF5: cannot give array " + path + " a checksum");
  }
  const Handle set(H5Dcreate2(file_, path.c_str(), type, space, H5P_DEFAULT, list, H5P_DEFAULT), H5Dclose,
                   "make array " + path);
  if (rows > 0 && H5Dwrite(set, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) < 0)
    throw Error("HDF5: cannot write array " + path + "; is the disk full?");
}

hsize_t Hdf5File::rows(const std::string& path, hsize_t width) const
{
  const Handle set(H5Dopen2(file_, path.c_str(), H5P_DEFAULT), H5Dclose, "open array " + path + "; it is missing");
  const Handle space(H5Dget_space(set), H5Sclose, "read the shape of " + path);
  hsize_t shape[2] = { 0, 1 };
  const int rank = H5Sget_simple_extent_ndims(space);
  if (rank < 1 || rank > 2 || H5Sget_simple_extent_dims(space, shape, nullptr) < 0 || shape[1] != width)
    throw Error(fmt::format("array {} has another shape; it must have {} numbers per entry", path, width));
  return shape[0];
}

void Hdf5File::read(const std::string& path, void* data, hsize_t rows, hid_t memory) const
{
  const Handle set(H5Dopen2(file_, path.c_str(), H5P_DEFAULT), H5Dclose, "open array " + path);
  if (rows > 0 && H5Dread(set, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) < 0)
    throw Error("array " + path + " cannot be read; the file is truncated or damaged");
}

void Hdf5File::write(const std::string& path, const std::vector<std::string>& strings)
{
  std::size_t length = 1;
  for (const std::string& s : strings)
    length = std::max(length, s.size());
  std::string buffer;
  for (std::string s : strings)
  {
    s.resize(length);
    buffer += s;
  }
  const Handle type(string_type(length), H5Tclose, "make a string type");
  write(path, buffer.data(), strings.size(), 1, type, type);
}

void Hdf5File::read(const std::string& path, std::vector<std::string>& strings) const
{
  strings.resize(rows(path, 1));
  const Handle set(H5Dopen2(file_, path.c_str(), H5P_DEFAULT), H5Dclose, "open array " + path);
  const Handle stored(H5Dget_type(set), H5Tclose, "read the type of " + path);
  if (H5Tget_class(stored) != H5T_STRING || H5Tis_variable_str(stored) > 0)
    throw Error("array " + path + " does not hold strings of fixed length");
  const std::size_t length = H5Tget_size(stored);
  std::string buffer(strings.size() * length, '\0');
  const Handle type(string_type(length), H5Tclose, "make a string type");
  read(path, buffer.data(), strings.size(), type);
  for (std::size_t s = 0; s < strings.size(); ++s)
  {
    strings[s] = buffer.substr(s * length, length);
    strings[s].resize(std::min(strings[s].find('\0'), length));
  }
}

void Hdf5File::write_attribute(const std::string& group, const std::string& name, hid_t space, hid_t memory, hid_t type,
                               const void* data)
{
  const Handle object(H5Oopen(file_, group.c_str(), H5P_DEFAULT), H5Oclose, "open " + group);
  const Handle shape(space, H5Sclose, "make the shape of " + name);
  const Handle attribute(H5Acreate2(object, name.c_str(), type, shape, H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
                         "make attribute " + name);
  if (H5Awrite(attribute, memory, data) < 0)
    throw Error("HDF5: cannot write attribute " + name);
}

void Hdf5File::write_attribute(const std::string& group, const std::string& name,
                               const std::vector<std::int64_t>& values)
{
  const hsize_t count = values.size();
  write_attribute(group, name, count == 1 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &count, nullptr),
                  H5T_NATIVE_INT64, H5T_STD_I64LE, values.data());
}

void Hdf5File::write_attribute(const std::string& group, const std::string& name, const std::string& value)
{
  const Handle type(string_type(value.size()), H5Tclose, "make a string type");
  write_attribute(group, name, H5Screate(H5S_SCALAR), type, type, value.c_str());
}

std::int64_t Hdf5File::attribute(const std::string& group, const std::string& name, std::int64_t otherwise) const
{
  if (!has(group) || H5Aexists_by_name(file_, group.c_str(), name.c_str(), H5P_DEFAULT) <= 0)
    return otherwise;
  const Handle attribute(H5Aopen_by_name(file_, group.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
                         "open attribute " + name);
  const Handle space(H5Aget_space(attribute), H5Sclose, "read the shape of " + name);
  std::int64_t value = otherwise;
  if (H5Sget_simple_extent_npoints(space) != 1 || H5Aread(attribute, H5T_NATIVE_INT64, &value) < 0)
    return otherwise;
  return value;
}

}  // namespace frontalis
