#include "frontalis/suggestion.hpp"
#include "scene/sections.hpp"

#include <algorithm>

namespace frontalis
{
namespace
{

/// Reads the name of a surface, a point, or a list of points.
MuscleEnd read_end(const Node& node, const SceneNames& names)
{
  MuscleEnd end;
  if (!node.is_list())
  {
    end.surface = node.reference(names.surfaces);
    return end;
  }
  const auto entries = node.entries();
  const bool one = entries.empty() || !entries.front().is_list();
  for (const Node& point : one ? std::vector<Node>{ node } : entries)
    end.points.push_back(point.vector(Dimension::length, any_number, {}));
  return end;
}

ControlNet read_net(const Node& node)
{
  ControlNet net;
  Mapping mapping(node);
  const std::string expected = "three whole numbers: control points along, across and through the muscle";
  const Node size = mapping.required("size", expected);
  const auto sizes = size.entries();
  if (size.is_list() && sizes.size() != 3)
    size.fault("found a list of {}; must be {}", sizes.size(), expected);
  for (std::size_t a = 0; sizes.size() == 3 && a < 3; ++a)
    net.size[a] = sizes[a].integer(2, 100, 2);
  net.ring = mapping.optional("ring").boolean(false);
  if (net.ring && sizes.size() == 3 && net.size[0] < 4)
    sizes[0].fault(sizes[0].found() + "; a ring has at least 4 control points along the fibres");
  const auto count = static_cast<std::size_t>(net.size[0]) * static_cast<std::size_t>(net.size[1]) *
                     static_cast<std::size_t>(net.size[2]);
  const Node points = mapping.required("points", "a list of control points [x, y, z]");
  for (const Node& point : points.entries())
    net.points.push_back(point.vector(Dimension::length, any_number, {}));
  if (points.is_list() && count > 0 && net.points.size() != count)
    points.fault("found {} points; size asks for {}", net.points.size(), count);
  const Node weights = mapping.optional("weights");
  for (const Node& weight : weights.entries())
    net.weights.push_back(weight.number(Dimension::number, positive, 1));
  if (weights.is_list() && count > 0 && net.weights.size() != count)
    weights.fault("found {} weights; size asks for {}", net.weights.size(), count);
  return net;
}

/// Reads the keys that define the fibres. A muscle may use at most one of the four alternatives.
void read_fibres(Mapping& mapping, const SceneNames& names, SceneMuscle& muscle)
{
  const Node fibre = mapping.optional("fibre"), net = mapping.optional("net"), ring = mapping.optional("ring"),
             origin = mapping.optional("origin"), insertion = mapping.optional("insertion");
  if (fibre.given())
    muscle.fibre = fibre.direction({ 0, 0, 1 });
  if (net.given())
    muscle.net = read_net(net);
  if (ring.given())
    muscle.ring = ring.boolean(false);
  if (origin.given())
    muscle.origin = read_end(origin, names);
  if (insertion.given())
    muscle.insertion = read_end(insertion, names);
  if (origin.given() != insertion.given())
    (origin.given() ? origin : insertion)
        .fault(std::string("stands without '") + (origin.given() ? "insertion" : "origin") +
               "'; give both ends or neither");
  std::string before;
  for (const auto& [node, name] : { std::make_pair(fibre, "fibre"), std::make_pair(net, "net"),
                                    std::make_pair(origin, "origin"), std::make_pair(ring, "ring") })
  {
    if (!node.given())
      continue;
    if (!before.empty())
      node.fault("stands beside '" + before + "'; fibres are given in one way only");
    before = name;
  }
}

/// Reads the keys that the muscles of a set may share. Keys that are not given leave their values unchanged.
void read_shared(Mapping& mapping, const SceneNames& names, SceneMuscle& muscle, std::string& material)
{
  if (const Node node = mapping.optional("material"); node.given())
    material = node.reference(names.materials);
  muscle.stress_reference =
      mapping.optional("stress_reference").number(Dimension::pressure, positive, muscle.stress_reference);
  muscle.cross_section = mapping.optional("cross_section").number(Dimension::area, positive, muscle.cross_section);
  muscle.rise_time = mapping.optional("rise_time").number(Dimension::time, not_negative, muscle.rise_time);
  muscle.fall_time = mapping.optional("fall_time").number(Dimension::time, not_negative, muscle.fall_time);
  muscle.tone = mapping.optional("tone").number(Dimension::number, proportion, muscle.tone);
  muscle.passive = mapping.optional("passive").boolean(muscle.passive);
  muscle.tension_length = mapping.optional("tension_length").boolean(muscle.tension_length);
}

/// Reads `tension_of`: the muscle stands for the tension that a material has at rest, whatever the fibres' length.
void read_tension(Mapping& mapping, const Scene& scene, const SceneNames& names, SceneMuscle& muscle)
{
  const Node of = mapping.optional("tension_of");
  if (!of.given())
    return;
  for (const char* key : { "stress_reference", "cross_section", "passive", "tension_length", "tone" })
    if (mapping.has(key))
      of.fault("stands beside '{}'; the material determines the stress", key);
  const std::string name = of.reference(names.materials);
  const auto material = std::find_if(scene.materials.begin(), scene.materials.end(),
                                     [&](const SceneMaterial& m) { return m.name == name; });
  if (material == scene.materials.end())
    return;
  if (material->tension == 0)
    of.fault("material '{}' has no 'tension'", name);
  // Values of a set that this muscle is an entry of do not count.
  muscle.stress_reference = material->tension;
  muscle.cross_section = 0;
  muscle.passive = false;
  muscle.tension_length = false;
  muscle.of_rest = true;
  muscle.tone = 1;
}

/// Finds the volume with the muscle's name. If there is none, makes a volume from the surface with that name.
void find_volume(const Node& key, const std::string& material, SceneMuscle& muscle, Scene& scene, SceneNames& names)
{
  muscle.volume = muscle.name;
  const bool there = names.volumes.has(muscle.name);
  if (there && !material.empty())
    key.fault("'material' stands beside a volume called '{}'; the material belongs there", muscle.name);
  if (there || !names.volumes.complete || !names.surfaces.complete)
    return;
  if (!names.surfaces.has(muscle.name))
  {
    key.fault("missing, and no volume is called '{}'; the volumes are {}", muscle.name,
              list_with_suggestion(muscle.name, names.volumes.names));
    return;
  }
  Volume volume;
  volume.name = muscle.name;
  volume.inside = { muscle.name };
  volume.material = material;
  volume.priority = 1;
  volume.line = muscle.line;
  scene.volumes.push_back(volume);
  names.volumes.names.push_back(volume.name);
}

/// The name without _left or _right.
std::string without_side(const std::string& name)
{
  const std::size_t at = name.rfind('_');
  const std::string side = at == std::string::npos ? "" : name.substr(at);
  return side == "_left" || side == "_right" ? name.substr(0, at) : name;
}

/// Names of the surfaces that `each` lists, and of the muscles in the sets that it lists, except those in `without`.
std::vector<std::string> read_members(const Node& each, const Node& without, const SceneNames& names)
{
  Names known = names.surfaces, members{ "muscle", {}, names.surfaces.complete };
  for (const auto& [set, muscles] : names.muscle_sets)
    known.names.push_back(set);
  for (const std::string& name : each.references(known))
    if (const auto set = names.muscle_sets.find(name); set != names.muscle_sets.end())
      members.names.insert(members.names.end(), set->second.begin(), set->second.end());
    else if (names.surfaces.has(name))
      members.names.push_back(name);
  if (without.given())
    for (const std::string& name : without.references(members))
      members.names.erase(std::remove(members.names.begin(), members.names.end(), name), members.names.end());
  return members.names;
}

}  // namespace

void read_muscles(const Node& node, Scene& scene, SceneNames& names)
{
  const auto entries = node.named_pairs();
  const auto place = [&](const std::string& name)
  { return std::find_if(scene.muscles.begin(), scene.muscles.end(), [&](const auto& m) { return m.name == name; }); };
  std::map<std::string, std::string> materials;
  // Sets are read first, so that the entry of a single muscle replaces the values of its set.
  for (const auto& [name, entry] : entries)
    if (entry.has("each"))
    {
      Mapping mapping(entry);
      SceneMuscle muscle;
      muscle.line = entry.line();
      std::string material;
      const Node each = mapping.optional("each");
      const std::vector<std::string> members = read_members(each, mapping.optional("without"), names);
      read_shared(mapping, names, muscle, material);
      for (const std::string& member : members)
      {
        if (place(member) != scene.muscles.end())
          each.fault("'{}' is in two sets; once is enough", member);
        muscle.name = member;
        muscle.volume.clear();
        if (!node.has(member) && !node.has(without_side(member)))
          find_volume(each, material, muscle, scene, names);
        materials[member] = material;
        scene.muscles.push_back(muscle);
      }
    }
  for (const auto& [name, entry] : entries)
  {
    if (entry.has("each"))
      continue;
    // A name without a side means both muscles of a set.
    Names made{ "muscle", {}, true };
    for (const SceneMuscle& muscle : scene.muscles)
      made.names.push_back(muscle.name);
    for (const std::string& one : made.both_sides(name))
    {
      if (place(one) == scene.muscles.end())
        scene.muscles.emplace_back().name = one;
      SceneMuscle& muscle = *place(one);
      muscle.line = entry.line();
      Mapping mapping(entry);
      const Node volume = mapping.optional("volume");
      if (volume.given())
        muscle.volume = volume.reference(names.volumes);
      if (volume.given() && mapping.has("material"))
        entry.fault("'material' stands beside 'volume', which has one");
      read_fibres(mapping, names, muscle);
      read_shared(mapping, names, muscle, materials[one]);
      read_tension(mapping, scene, names, muscle);
      if (!volume.given() && entry.is_mapping())
        find_volume(volume, materials[one], muscle, scene, names);
      if (entry.faulty())
        break;
    }
  }
  for (const SceneMuscle& muscle : scene.muscles)
    names.muscles.names.push_back(muscle.name);
  names.muscles.complete = !node.given() || node.is_mapping();
}

void read_weakness(const Node& node, Scene& scene, const SceneNames& names)
{
  for (const auto& [name, entry] : node.named_pairs())
  {
    SceneWeakness weakness;
    if (!entry.is_mapping())
    {
      weakness.muscles = names.muscles.both_sides(name);
      entry.check_known(weakness.muscles[0], names.muscles);
      weakness.keeps = entry.number(Dimension::number, proportion, 0);
      scene.weakness.push_back(weakness);
      continue;
    }
    Mapping mapping(entry);
    weakness.keeps = mapping.optional("keeps").number(Dimension::number, proportion, 0);
    if (const Node muscles = mapping.optional("muscles"); muscles.given())
      weakness.muscles = muscles.references(names.muscles);
    if (!weakness.muscles.empty() && !mapping.optional("sphere").given() && !mapping.optional("dose").given())
    {
      scene.weakness.push_back(weakness);
      continue;
    }
    const std::string where = one_of(entry, mapping, { "sphere", "dose" });
    if (where.empty())
      continue;
    weakness.dose = where == "dose";
    weakness.centre = mapping.optional(where).vector(Dimension::length, any_number, {});
    weakness.radius = mapping.required("radius", "a length greater than 0").number(Dimension::length, positive, 1);
    scene.weakness.push_back(weakness);
  }
}

}  // namespace frontalis
