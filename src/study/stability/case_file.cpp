#include "study/stability/case_file.hpp"

#include "frontalis/error.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <charconv>
#include <cmath>

namespace frontalis
{
namespace
{

// Splits "0.9", "20 ms" or "2 %" into number and unit. Returns false if the text does not begin with a finite number.
bool split(const std::string& text, double& number, std::string& unit)
{
  const std::from_chars_result read = std::from_chars(text.data(), text.data() + text.size(), number);
  if (read.ec != std::errc() || !std::isfinite(number))
    return false;
  const std::size_t rest = text.find_first_not_of(' ', static_cast<std::size_t>(read.ptr - text.data()));
  unit = rest == std::string::npos ? "" : text.substr(rest);
  return true;
}

}  // namespace

CaseFile::CaseFile(std::string path) : path_(std::move(path))
{
  try
  {
    const YAML::Node file = YAML::LoadFile(path_);
    const auto add = [&](const std::string& key, const YAML::Node& value)
    {
      std::vector<std::string>& texts = values_[key];
      if (value.IsSequence())
        for (const auto& entry : value)
          texts.push_back(entry.as<std::string>());
      else
        texts.push_back(value.as<std::string>());
    };
    for (const auto& entry : file)
    {
      const auto key = entry.first.as<std::string>();
      if (key == "hard")
        hard_ = entry.second.as<std::string>();
      else if (key == "text")
        text_ = entry.second.as<std::string>();
      else if (!entry.second.IsMap())
        add(key, entry.second);
      else
        for (const auto& inner : entry.second)
          add(key + "." + inner.first.as<std::string>(), inner.second);
    }
  }
  catch (const YAML::BadFile&)
  {
    throw Error(path_ + ": cannot be read");
  }
  catch (const YAML::Exception& error)
  {
    throw Error(fmt::format("{}:{}: {}", path_, error.mark.line + 1, error.msg));
  }
  if (hard_.empty())
    fault("hard", "is missing; must say in a few words what makes the case hard");
  if (text_.empty())
    fault("text", "is missing; must say what the case does and has to fulfil");
  // CMake makes a test of the case for each of these backends.
  for (const std::string& backend : values("tests"))
    if (backend != "cpu" && backend != "reference")
      fault("tests", "'" + backend + "'; allowed are cpu and reference");
  for (std::size_t open = text_.find('{'); open != std::string::npos; open = text_.find('{', open))
  {
    const std::size_t close = text_.find('}', open);
    if (close == std::string::npos)
      fault("text", "has a { without a }");
    const auto found = values_.find(text_.substr(open + 1, close - open - 1));
    if (found == values_.end() || found->second.size() != 1)
      fault("text", text_.substr(open, close - open + 1) + " is not a key with a single value");
    text_.replace(open, close - open + 1, found->second[0]);
  }
}

void CaseFile::fault(const std::string& key, const std::string& text) const
{
  throw Error(path_ + ": " + key + ": " + text);
}

const std::vector<std::string>& CaseFile::values(const std::string& key) const
{
  const auto found = values_.find(key);
  if (found == values_.end())
    fault(key, "is missing");
  asked_.insert(key);
  return found->second;
}

std::vector<double> CaseFile::numbers(const std::string& key, const std::string& unit, std::size_t count) const
{
  std::vector<double> numbers;
  for (const std::string& text : values(key))
  {
    std::string found_unit;
    if (!split(text, numbers.emplace_back(), found_unit) || found_unit != unit)
      fault(key, "'" + text + "'; must be a number " + (unit.empty() ? "without a unit" : "in " + unit));
  }
  if (numbers.empty() || (count > 0 && numbers.size() != count))
    fault(key, fmt::format("has {} values; must have {}", numbers.size(),
                           count > 0 ? fmt::to_string(count) : "one or more"));
  return numbers;
}

double CaseFile::seconds(const std::string& key) const
{
  const std::vector<std::string>& texts = values(key);
  double number = 0;
  std::string unit;
  if (texts.size() != 1 || !split(texts[0], number, unit) || (unit != "s" && unit != "ms"))
    fault(key, "must be one number in s or ms");
  return unit == "ms" ? 1e-3 * number : number;
}

std::array<std::int32_t, 3> CaseFile::size(const std::string& key) const
{
  const std::vector<double> found = numbers(key, {}, 3);
  for (const double voxels : found)
    if (!(voxels >= 1 && voxels <= 1000) || voxels != std::floor(voxels))
      fault(key, "must be three whole numbers of voxels from 1 to 1000");
  return { { static_cast<std::int32_t>(found[0]), static_cast<std::int32_t>(found[1]),
             static_cast<std::int32_t>(found[2]) } };
}

std::vector<std::string> CaseFile::unused() const
{
  std::vector<std::string> unused;
  for (const auto& [key, value] : values_)
    if (asked_.count(key) == 0)
      unused.push_back(key);
  return unused;
}

}  // namespace frontalis
