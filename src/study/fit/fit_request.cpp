#include "frontalis/study/fit.hpp"

#include "frontalis/error.hpp"
#include "frontalis/study/table.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

// Reads three coordinates [mm]; null means a free coordinate.
std::array<double, 3> coordinates_from(const YAML::Node& node)
{
  std::array<double, 3> out{};
  if (!node.IsSequence() || node.size() != 3)
    throw YAML::Exception(node.Mark(), "must be three coordinates in mm, such as [1.2, null, 6]");
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    out[axis] = node[axis].IsNull() ? NAN : millimetre * node[axis].as<double>();
    if (!node[axis].IsNull() && !std::isfinite(out[axis]))
      throw YAML::Exception(node.Mark(), "a coordinate is not finite; null leaves one free");
  }
  return out;
}

std::vector<Unknown> unknowns_from(const YAML::Node& node)
{
  std::vector<Unknown> out;
  if (!(node.IsSequence() || node.IsMap()) || node.size() == 0)
    throw YAML::Exception(node.Mark(), "must be a list of names, or a mapping of names to limits");
  if (node.IsSequence())
    for (const auto& name : node)
      out.push_back({ name.as<std::string>() });
  else
    for (const auto& entry : node)
    {
      if (!entry.second.IsSequence() || entry.second.size() != 2)
        throw YAML::Exception(entry.second.Mark(), "must be two limits, such as [-5, 5]");
      out.push_back({ entry.first.as<std::string>(), entry.second[0].as<double>(), entry.second[1].as<double>() });
    }
  return out;
}

}  // namespace

FitRequest read_fit_request(const std::string& path)
{
  FitRequest request;
  try
  {
    for (const auto& entry : YAML::LoadFile(path))
    {
      const auto key = entry.first.as<std::string>();
      if ((key == "moved" || key == "at") && !entry.second.IsMap())
        throw YAML::Exception(entry.second.Mark(), key + ": must be a mapping of landmarks to coordinates");
      if (key == "moved" || key == "at")
        for (const auto& target : entry.second)
          request.targets.push_back(
              { target.first.as<std::string>(), coordinates_from(target.second), key == "moved" });
      else if (key == "deviation")
        request.deviation = millimetre * entry.second.as<double>();
      else if (key == "unknowns")
        request.unknowns = unknowns_from(entry.second);
      else
        throw YAML::Exception(entry.first.Mark(), key + ": unknown key; allowed are moved, at, deviation and unknowns");
      if (!(request.deviation > 0) || !std::isfinite(request.deviation))
        throw YAML::Exception(entry.second.Mark(), "deviation: must be above 0 mm");
    }
  }
  catch (const YAML::BadFile&)
  {
    throw Error(path + ": cannot be read; must be a file of targets (doc/fitting.md)");
  }
  catch (const YAML::Exception& error)
  {
    throw Error(fmt::format("{}:{}: {}", path, error.mark.line + 1, error.msg));
  }
  return request;
}

}  // namespace frontalis
