#include "frontalis/runner/named_controls.hpp"

#include "frontalis/error.hpp"
#include "frontalis/solver/rigid_motion.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace frontalis
{
namespace
{

template <class Named>
std::vector<std::string> names_of(const std::vector<Named>& all)
{
  std::vector<std::string> names;
  names.reserve(all.size());
  for (const Named& named : all)
    names.push_back(named.name);
  return names;
}

std::string listed(const std::vector<std::string>& names)
{
  return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

std::size_t index_of(const std::vector<std::string>& names, const std::string& name)
{
  return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
}

}  // namespace

void set_activations(const Model& model, const std::map<std::string, double>& named, std::vector<float>& activation)
{
  std::vector<float> changed = activation;
  const std::vector<std::string> muscles = names_of(model.muscles);
  std::vector<std::string> unknown, faults;
  for (const auto& [name, value] : named)
  {
    const std::size_t muscle = index_of(muscles, name);
    if (muscle == muscles.size())
      unknown.push_back("'" + name + "'");
    else if (!(value >= 0 && value <= 1))
      faults.push_back(fmt::format("activation of '{}' is {}; must be from 0 to 1", name, value));
    else
      changed[muscle] = static_cast<float>(value);
  }
  if (!unknown.empty())
    faults.insert(faults.begin(),
                  fmt::format("no muscle is called {}; the muscles are {}", fmt::join(unknown, ", "), listed(muscles)));
  if (!faults.empty())
    throw Error(fmt::format("{}", fmt::join(faults, "; ")));
  activation = changed;
}

std::vector<float> expression_activation(const Model& model, const std::string& name)
{
  std::vector<float> activation(model.muscles.size(), 0);
  if (name == "relax")
    return activation;
  const std::vector<std::string> expressions = names_of(model.expressions);
  const std::size_t expression = index_of(expressions, name);
  if (expression == expressions.size())
    throw Error("no expression is called '" + name + "'; there is relax, " + listed(expressions));
  for (const auto& [muscle, value] : model.expressions[expression].activation)
    activation[static_cast<std::size_t>(muscle)] = value;
  return activation;
}

void set_bone_motion(const Model& model, const std::string& name, const RigidTransform& motion,
                     std::vector<RigidTransform>& bones)
{
  const std::size_t bone = index_of(model.bones, name);
  if (bone == model.bones.size())
    throw Error("no bone is called '" + name + "'; the bones are " + listed(model.bones));
  if (!is_rigid_motion(motion))
    throw Error("motion of bone '" + name + "' must be finite and rigid: a rotation and a translation");
  bones[bone] = composed(inverse(model.to_face), composed(motion, model.to_face));
}

std::vector<float> ActivationCurve::at(double seconds) const
{
  const auto after = std::upper_bound(time.begin(), time.end(), seconds) - time.begin();
  if (after == static_cast<std::ptrdiff_t>(time.size()))
    return activation.back();
  std::vector<float> value = activation[after - 1];
  const auto part = static_cast<float>((seconds - time[after - 1]) / (time[after] - time[after - 1]));
  for (std::size_t m = 0; m < value.size(); ++m)
    value[m] += part * (activation[after][m] - value[m]);
  return value;
}

}  // namespace frontalis
