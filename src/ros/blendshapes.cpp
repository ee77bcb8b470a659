#include "frontalis/ros/blendshapes.hpp"

#include "frontalis/error.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>

namespace frontalis
{

BlendshapeTable::BlendshapeTable(const std::string& file, const Model& model)
{
  if (file.empty())
    return;
  std::string row;
  try
  {
    for (const auto& entry : YAML::LoadFile(file))
    {
      row = entry.first.as<std::string>();
      auto& shares = rows_[row];
      for (const auto& share : entry.second)
      {
        const auto muscle = share.first.as<std::string>();
        const auto value = share.second.as<double>();
        if (!(value >= 0 && value <= 1))
          throw Error(fmt::format("{}: {}: {}: found {}; must be from 0 to 1", file, row, muscle, value));
        if (std::any_of(model.muscles.begin(), model.muscles.end(), [&](const auto& m) { return m.name == muscle; }))
          shares.emplace_back(muscle, value);
      }
    }
  }
  catch (const YAML::Exception& fault)
  {
    throw Error(fmt::format("{}: {}: must be a mapping of muscles to numbers from 0 to 1: {}", file,
                            row.empty() ? "blendshapes" : row, fault.what()));
  }
}

std::map<std::string, double> BlendshapeTable::activation(const std::vector<std::string>& names,
                                                          const std::vector<double>& weights,
                                                          std::set<std::string>& lacking) const
{
  std::map<std::string, double> out;
  std::set<std::string> seen;
  for (std::size_t entry = 0; entry < names.size(); ++entry)
  {
    const auto row = rows_.find(names[entry]);
    if (row == rows_.end())
      throw Error(fmt::format("no blendshape is called '{}'", names[entry]));
    if (!seen.insert(names[entry]).second)
      throw Error(fmt::format("blendshape '{}' is named twice", names[entry]));
    if (!(weights[entry] >= 0 && weights[entry] <= 1))
      throw Error(fmt::format("weight of '{}' is {}; must be from 0 to 1", names[entry], weights[entry]));
    if (row->second.empty())
      lacking.insert(names[entry]);
    for (const auto& [muscle, share] : row->second)
      out[muscle] = std::min(1.0, out[muscle] + share * weights[entry]);
  }
  return out;
}

}  // namespace frontalis
