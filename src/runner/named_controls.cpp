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

RigidTransform motion_in_face(const Model& model, const RigidTransform& local)
{
  return composed(model.to_face, composed(local, inverse(model.to_face)));
}

Controls ControlCurve::at(double seconds) const
{
  const auto after = std::upper_bound(time.begin(), time.end(), seconds) - time.begin();
  if (after == static_cast<std::ptrdiff_t>(time.size()))
    return controls.back();
  if (after == 0)
    return controls.front();
  return interpolate(controls[after - 1], controls[after],
                     (seconds - time[after - 1]) / (time[after] - time[after - 1]));
}

ControlCurve demo_curve(const Model& model, const Controls& begin)
{
  ControlCurve curve{ { 0 }, { begin } };
  Controls target = begin;
  double end = 0;
  for (const Model::DemoPhase& phase : model.demo)
  {
    if (!(phase.seconds > 0))
      continue;
    curve.time.push_back(end);
    curve.controls.push_back(target);
    if (phase.expression > -2)
      target.activation.assign(target.activation.size(), 0);
    if (phase.expression >= 0)
      for (const auto& [muscle, activation] : model.expressions.at(phase.expression).activation)
        target.activation.at(muscle) = activation;
    for (const Model::BonePose& pose : phase.bones)
      set_bone_motion(model, model.bones.at(pose.bone), rigid_motion(pose.turn, pose.shift), target.bone);
    curve.time.push_back(end + std::min(phase.ramp, phase.seconds));
    end += phase.seconds;
    curve.controls.push_back(target);
  }
  curve.time.push_back(end);
  curve.controls.push_back(target);
  return curve;
}

}  // namespace frontalis
