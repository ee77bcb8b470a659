#include "frontalis/ros/blendshapes.hpp"

#include "frontalis/error.hpp"
#include "frontalis/runner/named_controls.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>

namespace frontalis
{

namespace
{

// whether the model has this action unit, or an action unit of which `name` is the left or right half
bool has_unit(const Model& model, const std::string& name)
{
  return std::any_of(model.action_units.begin(), model.action_units.end(),
                     [&](const auto& unit)
                     { return name == unit.name || name == unit.name + "_left" || name == unit.name + "_right"; });
}

}  // namespace

BlendshapeTable::BlendshapeTable(const std::string& file, const Model& model)
{
  if (file.empty())
    return;
  std::string name;
  try
  {
    for (const auto& entry : YAML::LoadFile(file))
    {
      name = entry.first.as<std::string>();
      if (!entry.second.IsMap())
        throw YAML::Exception(entry.second.Mark(), "found no mapping");
      Row& row = rows_[name];
      for (const auto& share : entry.second)
      {
        const auto key = share.first.as<std::string>();
        const auto value = share.second.as<double>();
        if (!(value >= 0 && value <= 1))
          throw Error(fmt::format("{}: {}: {}: found {}; must be from 0 to 1", file, name, key, value));
        const auto& muscles = model.muscles;
        const auto muscle =
            std::find_if(muscles.begin(), muscles.end(), [&](const auto& known) { return known.name == key; });
        if (muscle != muscles.end())
          row.muscles.emplace_back(muscle - muscles.begin(), value);
        else if (has_unit(model, key))
          row.units.emplace_back(key, value);
      }
    }
  }
  catch (const YAML::Exception& fault)
  {
    throw Error(fmt::format("{}: {}: must be a mapping of muscles and action units to numbers from 0 to 1: {}", file,
                            name.empty() ? "blendshapes" : name, fault.what()));
  }
}

Controls BlendshapeTable::pose(const Model& model, const std::vector<std::string>& names,
                               const std::vector<double>& weights, std::set<std::string>& lacking) const
{
  std::vector<double> added(model.muscles.size(), 0.0);
  std::map<std::string, double> units;
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
    if (row->second.muscles.empty() && row->second.units.empty())
      lacking.insert(names[entry]);
    for (const auto& [muscle, share] : row->second.muscles)
      added[muscle] += share * weights[entry];
    for (const auto& [unit, share] : row->second.units)
      units[unit] = std::min(1.0, units[unit] + share * weights[entry]);
  }
  Controls pose = action_unit_controls(model, units);
  for (std::size_t muscle = 0; muscle < added.size(); ++muscle)
    pose.activation[muscle] = static_cast<float>(std::min(1.0, pose.activation[muscle] + added[muscle]));
  return pose;
}

}  // namespace frontalis
