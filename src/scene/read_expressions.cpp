#include "scene/sections.hpp"

#include <algorithm>
#include <filesystem>
#include <set>

namespace frontalis
{
namespace
{

constexpr Bound of_units{ -1, 1 };  // weights of muscles in action units; negative weights lower a tone

/// Reads poses of the face. Poses in the scene file may name only muscles and bones of the scene. Poses in a `shared`
/// file may name others, which are left out; a pose that becomes empty is left out too.
class PoseReader
{
public:
  PoseReader(Scene& scene, const SceneNames& names, bool shared) : scene_(scene), names_(names), shared_(shared) {}

  void read(const Node& node, const Bound& weights, FacePoses& poses) const
  {
    for (const auto& [name, entry] : node.named_pairs())
    {
      if (name == "relax")
      {
        entry.fault("'relax' is there in every scene, with all muscles at rest; choose another name");
        continue;
      }
      FacePose pose;
      std::set<std::string> named;
      for (const auto& [key, value] : entry.pairs())
        add(key, value, weights, pose, named);
      for (auto& [muscle, weight] : pose.activation)
        weight = std::clamp(weight, -1.0, 1.0);
      if (!shared_ || !pose.activation.empty() || !pose.bones.empty())
        poses[name] = pose;
    }
  }

  void read_bones(const Node& node, std::vector<BonePose>& poses) const
  {
    if (!node.given())
      return;
    for (const auto& [name, entry] : node.named_pairs())
      for (const std::string& bone : in_scene(name, entry, names_.bones))
        add_bone(pose_of(bone, entry), 1, poses);
  }

private:
  void add(const std::string& key, const Node& value, const Bound& weights, FacePose& pose,
           std::set<std::string>& named) const
  {
    if (key == "bones")
      return read_bones(value, pose.bones);
    if (value.is_null())
      return value.fault("found nothing; must be a number " + weights.text());
    const double weight = value.number(Dimension::number, weights, 0);
    if (const auto unit = scene_.action_units.find(key); unit != scene_.action_units.end())
    {
      for (const auto& [muscle, share] : unit->second.activation)
        pose.activation[muscle] += weight * share;
      for (const BonePose& bone : unit->second.bones)
        add_bone(bone, weight, pose.bones);
      return;
    }
    for (const std::string& muscle : in_scene(key, value, names_.activations))
      if (named.insert(muscle).second)
        pose.activation[muscle] += weight;
      else
        value.fault("'{}' has an activation already; a muscle may stand once", muscle);
  }

  static void add_bone(const BonePose& added, double share, std::vector<BonePose>& poses)
  {
    auto pose = std::find_if(poses.begin(), poses.end(), [&](const BonePose& p) { return p.bone == added.bone; });
    if (pose == poses.end())
      pose = poses.insert(pose, { added.bone, {}, {}, 0 });
    pose->angle += share * added.angle;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      pose->shift[axis] += share * added.shift[axis];
      pose->turn[axis] += share * added.turn[axis];
    }
  }

  BonePose pose_of(const std::string& bone, const Node& entry) const
  {
    BonePose pose;
    pose.bone = bone;
    Mapping mapping(entry);
    pose.shift = mapping.optional("shift").vector(Dimension::length, any_number, pose.shift);
    pose.turn = mapping.optional("turn").vector(Dimension::angle, any_number, pose.turn);
    const Node angle = mapping.optional("angle");
    pose.angle = angle.number(Dimension::angle, any_number, 0);
    const auto& joints = scene_.joints;
    if (angle.given() && std::none_of(joints.begin(), joints.end(), [&](const auto& j) { return j.bone == bone; }))
      angle.fault("'{}' has no joint; 'joints' must have one, or the pose 'shift' and 'turn'", bone);
    return pose;
  }

  /// The muscles or bones that a name stands for; for a shared file, none if the scene lacks them.
  std::vector<std::string> in_scene(const std::string& name, const Node& place, const Names& known) const
  {
    std::vector<std::string> meant = known.both_sides(name);
    if (!shared_)
      place.check_known(meant[0], known);
    else if (!known.has(meant[0]))
    {
      // A scene may have one of both sides.
      meant = { name + "_left", name + "_right" };
      meant.erase(std::remove_if(meant.begin(), meant.end(), [&](const auto& side) { return !known.has(side); }),
                  meant.end());
    }
    return meant;
  }

  Scene& scene_;
  const SceneNames& names_;
  bool shared_;
};

/// Reads action units and expressions from a file that several scenes share.
void read_shared_poses(const Node& file, Scene& scene, const SceneNames& names)
{
  const std::string path = (std::filesystem::path(scene.file).parent_path() / file.text()).string();
  const YAML::Node yaml = load_yaml(path, "action units", "a mapping with unit, action_units, expressions");
  ReadingContext context{ Faults(path), 1 };
  {
    Mapping mapping(Node(yaml, "", 1, context));
    context.length_unit = read_length_unit(mapping.required("unit", "the length unit of plain numbers"), 1);
    const PoseReader reader(scene, names, true);
    reader.read(mapping.required("action_units", "a mapping of action units"), of_units, scene.action_units);
    reader.read(mapping.optional("expressions"), proportion, scene.expressions);
  }
  if (!context.faults.empty())
    throw Error(context.faults.text());
}

}  // namespace

void read_bone_centres(const Node& node, Scene& scene, const SceneNames& names)
{
  for (const auto& [bone, entry] : node.named_pairs())
  {
    entry.check_known(bone, names.bones);
    Mapping mapping(entry);
    scene.bone_centres[bone] =
        mapping.required("centre", "the point that the bone turns about").vector(Dimension::length, any_number, {});
  }
}

void read_expressions(const Node& action_units, const Node& expressions, Scene& scene, SceneNames& names)
{
  if (action_units.is_text())
    read_shared_poses(action_units, scene, names);
  const PoseReader reader(scene, names, false);
  if (!action_units.is_text())
    reader.read(action_units, of_units, scene.action_units);
  reader.read(expressions, proportion, scene.expressions);
  for (const auto& [name, pose] : scene.expressions)
    names.expressions.names.push_back(name);
  names.expressions.complete = !expressions.given() || expressions.is_mapping();
}

void read_demo(const Node& node, Scene& scene, const SceneNames& names)
{
  for (const Node& entry : node.entries())
  {
    DemoPhase phase;
    Mapping mapping(entry);
    phase.expression = mapping.optional("expression").reference(names.expressions);
    PoseReader(scene, names, false).read_bones(mapping.optional("bones"), phase.bones);
    if (!mapping.has("expression") && !mapping.has("bones"))
      entry.fault("has neither 'expression' nor 'bones'; must have at least one of them");
    const Node ramp = mapping.optional("ramp");
    phase.ramp = ramp.number(Dimension::time, not_negative, phase.ramp);
    phase.seconds = mapping.optional("seconds").number(Dimension::time, positive, phase.seconds);
    if (phase.ramp > phase.seconds)
    {
      if (ramp.given())
        ramp.fault(ramp.found() + "; must be at most 'seconds', which includes the ramp");
      else
        phase.ramp = phase.seconds;
    }
    scene.demo.push_back(phase);
  }
}

}  // namespace frontalis
