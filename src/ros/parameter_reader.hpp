#pragma once

#include "frontalis/error.hpp"

#include <fmt/format.h>
#include <ros/node_handle.h>

#include <cmath>
#include <string>

namespace frontalis
{

/// Reads parameters one by one and collects their faults.
class ParameterReader
{
public:
  explicit ParameterReader(const ros::NodeHandle& handle) : handle_(handle) {}

  std::string text(const std::string& key, const std::string& fallback)
  {
    std::string value = fallback;
    int number = 0;
    if (!handle_.hasParam(key) || handle_.getParam(key, value))
      return value;
    // roslaunch turns a text such as "1" into a number
    if (handle_.getParam(key, number))
      return std::to_string(number);
    add_fault(key, "has the wrong type; allowed is a text");
    return fallback;
  }

  template <typename T>
  T value(const std::string& key, T fallback, const char* allowed)
  {
    T found = fallback;
    if (handle_.hasParam(key) && !handle_.getParam(key, found))
      add_fault(key, fmt::format("has the wrong type; allowed is {}", allowed));
    return found;
  }

  /// Reads a finite number that is at least `least`.
  template <typename T>
  T number(const std::string& key, T fallback, const char* type, T least, const char* allowed)
  {
    const T found = value(key, fallback, type);
    if (!(found >= least) || !std::isfinite(found))
      add_fault(key, fmt::format("found {}; allowed is {}", found, allowed));
    return found;
  }

  /// Reads a text parameter and returns value_of(text), which throws an Error if the text is not allowed.
  template <typename Value>
  Value named(const std::string& key, const std::string& fallback, Value (*value_of)(const std::string&))
  {
    try
    {
      return value_of(text(key, fallback));
    }
    catch (const Error& error)
    {
      add_fault(key, error.what());
      return value_of(fallback);
    }
  }

  void add_fault(const std::string& key, const std::string& fault)
  {
    faults_ += fmt::format("\n{}: {}", handle_.resolveName(key), fault);
  }

  /// Throws an Error that names all faults.
  void finish() const
  {
    if (!faults_.empty())
      throw Error("bad parameters:" + faults_);
  }

private:
  ros::NodeHandle handle_;
  std::string faults_;
};

}  // namespace frontalis
