#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace frontalis
{

/// A hard case as it is written down (test/stability/NAME.yaml): what is hard, in words, its sizes, times and bounds.
/// Values are a number with a unit behind it, or a list of such; keys of a mapping are reached by a dot
/// ("bounds.energy"). Every function throws Error with file and key where a value is missing or has another unit than
/// is asked for.
class CaseFile
{
public:
  explicit CaseFile(std::string path);

  const std::string& hard() const { return hard_; }  ///< what is hard about it, in a few words
  const std::string& text() const { return text_; }  ///< markdown; {KEY} stands for the value of that key

  /// count 0: as many as there are.
  std::vector<double> numbers(const std::string& key, const std::string& unit = {}, std::size_t count = 0) const;
  double number(const std::string& key, const std::string& unit = {}) const;
  double seconds(const std::string& key) const;                             ///< of ms or s
  std::array<std::int32_t, 3> size(const std::string& key = "size") const;  ///< voxels
  double bound(const std::string& key, const std::string& unit = {}) const { return number("bounds." + key, unit); }

  /// Keys that nobody has asked for.
  std::vector<std::string> idle() const;

private:
  [[noreturn]] void fault(const std::string& key, const std::string& text) const;
  const std::vector<std::string>& values(const std::string& key) const;

  std::string path_, hard_, text_;
  std::map<std::string, std::vector<std::string>> values_;
  mutable std::set<std::string> asked_;
};

}  // namespace frontalis
