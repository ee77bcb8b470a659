#pragma once

#include "frontalis/error.hpp"
#include "model/hdf5_file.hpp"

#include <fmt/format.h>

#include <string>
#include <type_traits>
#include <vector>

namespace frontalis
{

/// Names a member of a structure as a column of a table in the file.
template <class Row, class Value>
struct Column
{
  const char* name;
  Value Row::*field;
  /// bool is stored as bytes, because std::vector<bool> is not an array in memory.
  using Values = std::vector<std::conditional_t<std::is_same_v<Value, bool>, std::uint8_t, Value>>;
};
template <class Row, class Value>
Column(const char*, Value Row::*) -> Column<Row, Value>;

/// Writes the fields of a model to a group of the file: arrays, single values, and vectors of structures as tables.
class ModelWriter
{
public:
  ModelWriter(Hdf5File& file, std::string group) : file_(file), group_(std::move(group)) {}

  /// Whether the file has a group that is stored only if `stored` is true.
  bool group_if(bool stored, const std::string&) const { return stored; }

  template <class T>
  void operator()(const std::string& path, const std::vector<T>& values)
  {
    file_.write(group_ + "/" + path, values);
  }
  template <class T>
  void operator()(const std::string& path, const T& value)
  {
    (*this)(path, std::vector<T>{ value });
  }
  template <class Row, class... Of, class... Value>
  void table(const std::string& path, const std::vector<Row>& rows, const Column<Of, Value>&... columns)
  {
    const auto put = [&](const auto& column)
    {
      typename std::decay_t<decltype(column)>::Values values;
      values.reserve(rows.size());
      for (const Row& row : rows)
        values.push_back(row.*column.field);
      (*this)(path + "/" + column.name, values);
    };
    (put(columns), ...);
  }

private:
  Hdf5File& file_;
  std::string group_;
};

/// Reads the fields of a model from a group of the file.
class ModelReader
{
public:
  ModelReader(const Hdf5File& file, std::string group) : file_(file), group_(std::move(group)) {}

  bool group_if(bool, const std::string& path) const { return file_.has(group_ + "/" + path); }

  template <class T>
  void operator()(const std::string& path, std::vector<T>& values)
  {
    file_.read(group_ + "/" + path, values);
  }
  template <class T>
  void operator()(const std::string& path, T& value)
  {
    std::vector<T> one;
    (*this)(path, one);
    if (one.size() != 1)
      throw Error(fmt::format("array {}/{} has {} entries; it must have 1", group_, path, one.size()));
    value = one.front();
  }
  template <class Row, class... Of, class... Value>
  void table(const std::string& path, std::vector<Row>& rows, const Column<Of, Value>&... columns)
  {
    const auto take = [&](const auto& column)
    {
      typename std::decay_t<decltype(column)>::Values values;
      (*this)(path + "/" + column.name, values);
      if (rows.empty())
        rows.resize(values.size());
      if (rows.size() != values.size())
        throw Error(fmt::format("array {}/{}/{} has {} entries; its neighbours have {}", group_, path, column.name,
                                values.size(), rows.size()));
      for (std::size_t r = 0; r < rows.size(); ++r)
        rows[r].*column.field = values[r];
    };
    (take(columns), ...);
  }

private:
  const Hdf5File& file_;
  std::string group_;
};

}  // namespace frontalis
