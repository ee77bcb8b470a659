#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace frontalis
{

/// The file of a hard case (test/stability/NAME.yaml): a description, sizes, times and bounds. A value is a number with
/// its unit, or a list of them; a dot names keys inside a mapping ("bounds.energy"). Every function throws Error with
/// file and key if a value is missing or does not have the requested unit.
class CaseFile
{
public:
  explicit CaseFile(std::string path);

  const std::string& hard() const { return hard_; }  ///< what makes the case hard, in a few words
  const std::string& text() const { return text_; }  ///< markdown, with {KEY} replaced by the value of the key

  /// `count`: required number of values; 0: one or more.
  std::vector<double> numbers(const std::string& key, const std::string& unit = {}, std::size_t count = 0) const;
  double number(const std::string& key, const std::string& unit = {}) const { return numbers(key, unit, 1)[0]; }
  double seconds(const std::string& key) const;  ///< a time [s], which the file gives in ms or s
  std::array<std::int32_t, 3> size(const std::string& key = "size") const;  ///< a size in voxels
  const std::vector<std::string>& words(const std::string& key) const { return values(key); }

  /// Keys of the file that no function has read.
  std::vector<std::string> unused() const;

private:
  [[noreturn]] void fault(const std::string& key, const std::string& text) const;
  const std::vector<std::string>& values(const std::string& key) const;

  std::string path_, hard_, text_;
  std::map<std::string, std::vector<std::string>> values_;
  mutable std::set<std::string> asked_;
};

}  // namespace frontalis
