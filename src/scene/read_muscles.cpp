#include "scene/sections.hpp"

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

}  // namespace

void read_muscles(const Node& node, Scene& scene, SceneNames& names)
{
  const auto read = [&](const Node& entry, Mapping& mapping, SceneMuscle& muscle)
  {
    const Node volume = mapping.optional("volume");
    muscle.volume = volume.given() ? volume.reference(names.volumes) : muscle.name;
    if (!volume.given() && entry.is_mapping() && names.volumes.complete && !names.volumes.has(muscle.name))
      volume.fault("missing, and no volume is called '{}'; the volumes are {}", muscle.name,
                   list_with_suggestion(muscle.name, names.volumes.names));
    read_fibres(mapping, names, muscle);
    muscle.stress_reference =
        mapping.optional("stress_reference").number(Dimension::pressure, positive, muscle.stress_reference);
    muscle.rise_time = mapping.optional("rise_time").number(Dimension::time, not_negative, 0);
    muscle.fall_time = mapping.optional("fall_time").number(Dimension::time, not_negative, 0);
    muscle.tone = mapping.optional("tone").number(Dimension::number, proportion, 0);
    muscle.passive = mapping.optional("passive").boolean(muscle.passive);
    muscle.tension_length = mapping.optional("tension_length").boolean(muscle.tension_length);
  };
  read_named(node, scene.muscles, names.muscles, read);
  names.muscles.complete = !node.given() || node.is_mapping();
}

void read_weakness(const Node& node, Scene& scene, const SceneNames& names)
{
  for (const auto& [name, entry] : node.named_pairs())
  {
    SceneWeakness weakness;
    if (!entry.is_mapping())
    {
      entry.check_known(name, names.muscles);
      weakness.muscles = { name };
      weakness.keeps = entry.number(Dimension::number, proportion, 0);
      scene.weakness.push_back(weakness);
      continue;
    }
    Mapping mapping(entry);
    weakness.keeps = mapping.optional("keeps").number(Dimension::number, proportion, 0);
    if (const Node muscles = mapping.optional("muscles"); muscles.given())
      weakness.muscles = muscles.references(names.muscles);
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
