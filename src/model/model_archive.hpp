#pragma once

#include "frontalis/error.hpp"
#include "model/hdf5_file.hpp"

#include <fmt/format.h>

#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

namespace frontalis
{

/// Puts the fields of a model into the file.
class ModelWriter
{
public:
  explicit ModelWriter(Hdf5File& file) : file_(file) {}

  void group(const std::string& path) { file_.make_group(path); }
  /// Whether to go on with a group that is only in files where `stored` holds.
  bool group_if(bool stored, const std::string& path)
  {
    if (stored)
      group(path);
    return stored;
  }

  template <class T>
  void array(const std::string& path, const std::vector<T>& values)
  {
    using Element = Hdf5Element<T>;
    file_.write(path, reinterpret_cast<const typename Element::Number*>(values.data()), values.size(), Element::width);
  }

  void strings(const std::string& path, const std::vector<std::string>& values) { file_.write_strings(path, values); }

  template <class T>
  void value(const std::string& path, const T& value)
  {
    if constexpr (std::is_same_v<T, std::string>)
      strings(path, { value });
    else
      column(path, std::vector<Single<T>>{ { value } }, &Single<T>::value);
  }

  /// One field of a vector of structures.
  template <class S, class T, class P = S>
  void column(const std::string& path, const std::vector<S>& entries, T P::*field)
  {
    if constexpr (std::is_same_v<T, std::string>)
    {
      std::vector<std::string> values;
      values.reserve(entries.size());
      for (const S& entry : entries)
        values.push_back(entry.*field);
      strings(path, values);
    }
    else
    {
      using Element = Hdf5Element<T>;
      std::vector<typename Element::Number> values(entries.size() * Element::width);
      for (std::size_t e = 0; e < entries.size(); ++e)
        std::memcpy(values.data() + e * Element::width, &(entries[e].*field), sizeof(T));
      file_.write(path, values.data(), entries.size(), Element::width);
    }
  }

  template <class T>
  struct Single
  {
    T value;
  };

private:
  Hdf5File& file_;
};

/// Takes the fields of a model from the file.
class ModelReader
{
public:
  explicit ModelReader(const Hdf5File& file) : file_(file) {}

  void group(const std::string&) {}
  bool group_if(bool, const std::string& path) { return file_.has(path); }

  template <class T>
  void array(const std::string& path, std::vector<T>& values)
  {
    using Element = Hdf5Element<T>;
    values.resize(file_.rows(path, Element::width));
    file_.read(path, reinterpret_cast<typename Element::Number*>(values.data()), values.size(), Element::width);
  }

  void strings(const std::string& path, std::vector<std::string>& values) { values = file_.read_strings(path); }

  template <class T>
  void value(const std::string& path, T& value)
  {
    std::vector<ModelWriter::Single<T>> one;
    column(path, one, &ModelWriter::Single<T>::value);
    if (one.size() != 1)
      throw Error(fmt::format("array {} has {} entries; it must have 1", path, one.size()));
    value = one.front().value;
  }

  template <class S, class T, class P = S>
  void column(const std::string& path, std::vector<S>& entries, T P::*field)
  {
    if constexpr (std::is_same_v<T, std::string>)
    {
      const std::vector<std::string> values = file_.read_strings(path);
      resize(path, entries, values.size());
      for (std::size_t e = 0; e < entries.size(); ++e)
        entries[e].*field = values[e];
    }
    else
    {
      using Element = Hdf5Element<T>;
      resize(path, entries, file_.rows(path, Element::width));
      std::vector<typename Element::Number> values(entries.size() * Element::width);
      file_.read(path, values.data(), entries.size(), Element::width);
      for (std::size_t e = 0; e < entries.size(); ++e)
        std::memcpy(&(entries[e].*field), values.data() + e * Element::width, sizeof(T));
    }
  }

private:
  template <class S>
  static void resize(const std::string& path, std::vector<S>& entries, std::size_t count)
  {
    if (entries.empty())
      entries.resize(count);
    else if (entries.size() != count)
      throw Error(fmt::format("array {} has {} entries; its neighbours have {}", path, count, entries.size()));
  }

  const Hdf5File& file_;
};

}  // namespace frontalis
