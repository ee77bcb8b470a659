#include "frontalis/study/faces.hpp"

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

Error fault(const std::string& path, const YAML::Mark& mark, const std::string& text)
{
  return Error(fmt::format("{}:{}: {}", path, mark.line + 1, text));
}

PublishedMotion motion_from(const YAML::Node& entry)
{
  PublishedMotion motion;
  motion.landmark = entry["landmark"].as<std::string>();
  motion.along = entry["along"].as<std::array<double, 3>>();
  motion.mean = millimetre * entry["mean"].as<double>();
  motion.deviation = millimetre * entry["sd"].as<double>(0);
  motion.component = entry["component"].as<bool>(false);
  motion.mark = entry["mark"].as<std::string>();
  motion.source = entry["source"].as<std::string>();
  const double length = std::hypot(motion.along[0], motion.along[1], motion.along[2]);
  if (!(length > 0) || !(motion.mean > 0) || !(motion.deviation >= 0))
    throw YAML::Exception(entry.Mark(), "the direction 'along' has no length, or a mean or sd is not above 0");
  for (double& axis : motion.along)
    axis /= length;
  return motion;
}

void check_keys(const YAML::Node& mapping, const std::vector<std::string>& allowed)
{
  for (const auto& entry : mapping)
    if (const auto key = entry.first.as<std::string>(); std::find(allowed.begin(), allowed.end(), key) == allowed.end())
      throw YAML::Exception(entry.first.Mark(),
                            fmt::format("{}: unknown key; allowed are {}", key, fmt::join(allowed, ", ")));
}

}  // namespace

People read_people(const std::string& path)
{
  People people;
  try
  {
    const YAML::Node root = YAML::LoadFile(path);
    if (!root.IsMap())
      throw YAML::Exception(root.Mark(), "must be a mapping from expressions to motions of people");
    for (const auto& entry : root)
    {
      if (!entry.second.IsMap())
        throw YAML::Exception(entry.second.Mark(), "must be a mapping with settles, still and landmarks");
      people.order.push_back(entry.first.as<std::string>());
      PublishedExpression& expression = people.expressions[people.order.back()];
      check_keys(entry.second, { "settles", "still", "landmarks" });
      expression.settles = entry.second["settles"].as<double>(0);
      expression.still = entry.second["still"].as<std::vector<std::string>>(std::vector<std::string>());
      for (const auto& motion : entry.second["landmarks"])
      {
        check_keys(motion, { "landmark", "along", "mean", "sd", "component", "mark", "source" });
        expression.motions.push_back(motion_from(motion));
      }
    }
  }
  catch (const YAML::BadFile&)
  {
    throw Error(path + ": cannot be read; must be a file such as config/people.yaml");
  }
  catch (const YAML::Exception& error)
  {
    throw fault(path, error.mark, error.msg);
  }
  return people;
}

}  // namespace frontalis
