#include "frontalis/runner/named_controls.hpp"

#include "frontalis/error.hpp"
#include "frontalis/physics/number.hpp"
#include "frontalis/solver/rigid_motion.hpp"
#include "frontalis/suggestion.hpp"

#include <boost/algorithm/string/predicate.hpp>
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

std::size_t index_of(const std::vector<std::string>& names, const std::string& name)
{
  return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
}

// Converts a fraction of a bone's pose to a motion in the local frame.
RigidTransform motion_of(const Model& model, const Model::BonePose& pose, double share)
{
  std::array<double, 3> turn{}, shift{}, from_centre{};
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    turn[axis] = share * pose.turn[axis];
    shift[axis] = share * pose.shift[axis] + pose.centre[axis];
    from_centre[axis] = -pose.centre[axis];
  }
  const RigidTransform in_face = composed(rigid_motion(turn, shift), rigid_motion({}, from_centre));
  return composed(inverse(model.to_face), composed(in_face, model.to_face));
}

// Fraction of a one-sided pose that a muscle or bone gets: 1 on that side, half if it belongs to no side, else 0.
double share_of_side(const std::string& name, const std::string& side)
{
  const auto is_of = [&](const char* end) { return boost::algorithm::ends_with(name, end); };
  if (side.empty())
    return 1;
  return is_of(side.c_str()) ? 1 : is_of("_left") || is_of("_right") ? 0 : 0.5;
}

// Adds a pose by its name, or by its name with _left or _right. Returns false if there is no such pose.
bool add_pose(const Model& model, const std::vector<Model::Expression>& poses, const std::string& name,
              double intensity, Controls& controls)
{
  for (const std::string side : { "", "_left", "_right" })
    for (const Model::Expression& pose : poses)
      if (pose.name + side == name)
      {
        for (const auto& [muscle, weight] : pose.activation)
          controls.activation[muscle] +=
              static_cast<float>(intensity * share_of_side(model.muscles[muscle].name, side)) * weight;
        for (const Model::BonePose& bone : pose.bones)
          controls.bone[bone.bone] =
              composed(motion_of(model, bone, intensity * share_of_side(model.bones[bone.bone], side)),
                       controls.bone[bone.bone]);
        return true;
      }
  return false;
}

// Splits the name of an action unit with a FACS letter from A (trace) to E (maximum), such as AU12C or AU12C_left, into
// the name without the letter and the letter's fraction of the full intensity, 1 to 5 fifths. Other names have the
// fraction 1.
std::pair<std::string, double> without_letter(const std::string& name)
{
  const std::size_t digit = name.find_last_of("0123456789");
  if (digit == std::string::npos || digit + 1 == name.size() || name[digit + 1] < 'A' || name[digit + 1] > 'E')
    return { name, 1 };
  return { name.substr(0, digit + 1) + name.substr(digit + 2), (name[digit + 1] - 'A' + 1) / 5.0 };
}

Controls limited(Controls controls)
{
  for (float& activation : controls.activation)
    activation = std::clamp(activation, 0.0f, 1.0f);
  return controls;
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
      unknown.push_back("'" + name + "'" + suggestion(name, muscles));
    else if (!(value >= 0 && value <= 1))
      faults.push_back(fmt::format("activation of '{}' is {}; must be from 0 to 1", name, value));
    else
      changed[muscle] = static_cast<float>(value);
  }
  if (!unknown.empty())
    faults.insert(faults.begin(), fmt::format("no muscle is called {}; the muscles are {}", fmt::join(unknown, ", "),
                                              list_with_suggestion("", muscles)));
  if (!faults.empty())
    throw Error(fmt::format("{}", fmt::join(faults, "; ")));
  activation = changed;
}

Controls rest_controls(const Model& model)
{
  Controls rest{ std::vector<float>(model.muscles.size(), 0), std::vector<RigidTransform>(model.bones.size()) };
  for (std::size_t m = 0; m < model.muscles.size(); ++m)
    rest.activation[m] = static_cast<float>(model.muscles[m].tone);
  return rest;
}

Controls expression_controls(const Model& model, const std::string& name)
{
  Controls controls = rest_controls(model);
  if (name != "relax" && !add_pose(model, model.expressions, name, 1, controls))
  {
    std::vector<std::string> known = names_of(model.expressions);
    known.insert(known.begin(), "relax");
    throw Error("no expression is called '" + name + "'; there is " + list_with_suggestion(name, known));
  }
  return limited(controls);
}

Controls action_unit_controls(const Model& model, const std::map<std::string, double>& intensities)
{
  Controls controls = rest_controls(model);
  for (const auto& [name, intensity] : intensities)
  {
    if (!(intensity >= 0 && intensity <= 1))
      throw Error(fmt::format("intensity of action unit '{}' is {}; must be from 0 to 1", name, intensity));
    const auto [unit, share] = without_letter(name);
    if (!add_pose(model, model.action_units, name, intensity, controls) &&
        !add_pose(model, model.action_units, unit, share * intensity, controls))
      throw Error("no action unit is called '" + name + "'; there is " +
                  list_with_suggestion("", names_of(model.action_units)));
  }
  return limited(controls);
}

Controls value_controls(const Model& model, const std::map<std::string, double>& values)
{
  static const std::array<std::string, 6> axes{ { "x", "y", "z", "rx", "ry", "rz" } };
  constexpr double millimetre = 1e-3, degree = physics::pi / 180;
  Controls controls = rest_controls(model);
  std::map<std::string, double> activation;
  std::map<std::string, std::array<double, 6>> motions;
  for (const auto& [name, value] : values)
  {
    const std::size_t dot = name.rfind('.');
    if (dot == std::string::npos)
    {
      activation[name] = value;
      continue;
    }
    const auto axis = std::find(axes.begin(), axes.end(), name.substr(dot + 1));
    if (axis == axes.end())
      throw Error("'" + name + "' is no muscle, nor a bone's .x, .y, .z, .rx, .ry or .rz");
    const auto index = static_cast<std::size_t>(axis - axes.begin());
    motions[name.substr(0, dot)][index] = value * (index < 3 ? millimetre : degree);
  }
  set_activations(model, activation, controls.activation);
  for (const auto& [bone, m] : motions)
    set_bone_motion(model, bone, rigid_motion({ { m[3], m[4], m[5] } }, { { m[0], m[1], m[2] } }), controls.bone);
  return controls;
}

void take_pose(const Model& model, const Controls& pose, Controls& controls)
{
  controls.activation = pose.activation;
  for (const auto* poses : { &model.expressions, &model.action_units })
    for (const Model::Expression& known : *poses)
      for (const Model::BonePose& bone : known.bones)
        controls.bone[bone.bone] = pose.bone[bone.bone];
}

void set_bone_motion(const Model& model, const std::string& name, const RigidTransform& motion,
                     std::vector<RigidTransform>& bones)
{
  const std::size_t bone = index_of(model.bones, name);
  if (bone == model.bones.size())
    throw Error("no bone is called '" + name + "'; the bones are " + list_with_suggestion(name, model.bones));
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
      take_pose(
          model,
          expression_controls(model, phase.expression < 0 ? "relax" : model.expressions.at(phase.expression).name),
          target);
    for (const Model::BonePose& pose : phase.bones)
      target.bone.at(pose.bone) = motion_of(model, pose, 1);
    curve.time.push_back(end + std::min(phase.ramp, phase.seconds));
    end += phase.seconds;
    curve.controls.push_back(target);
  }
  curve.time.push_back(end);
  curve.controls.push_back(target);
  return curve;
}

}  // namespace frontalis
