#include "scene/sections.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{

void read_frame(const Node& node, FaceFrame& frame)
{
  if (!node.given())
    return;
  Mapping mapping(node);
  if (const Node id = mapping.optional("id"); id.given())
    frame.id = id.name();
  frame.origin = mapping.optional("origin").vector(Dimension::length, any_number, frame.origin);
  const Node up = mapping.optional("up");
  frame.forward = mapping.optional("forward").direction(frame.forward);
  frame.up = up.direction(frame.up);

  // Makes `up` orthogonal to `forward`.
  const Vector3& f = frame.forward;
  const double along = frame.up[0] * f[0] + frame.up[1] * f[1] + frame.up[2] * f[2];
  const Vector3 across{ frame.up[0] - along * f[0], frame.up[1] - along * f[1], frame.up[2] - along * f[2] };
  const double length = std::hypot(across[0], across[1], across[2]);
  if (length < 1e-6)
    (up.given() ? up : node).fault("up is parallel to forward; must point another way");
  else
    frame.up = { across[0] / length, across[1] / length, across[2] / length };
}

void read_skin(const Node& node, Scene& scene, const SceneNames& names)
{
  if (!node.given())
    return;
  Mapping mapping(node);
  SceneSkin& skin = scene.skin;
  skin.surface = mapping.required("surface", "the name of the surface to publish").reference(names.surfaces);
  skin.crop = read_region(mapping.optional("crop"));
  if (const Node lines = mapping.optional("fine_lines"); lines.given())
    for (const Node& entry : lines.is_list() ? lines.entries() : std::vector<Node>{ lines })
    {
      Mapping mapping_of_film(entry);
      SceneFilm film;
      film.material = mapping_of_film.required("material", "the material of the film").reference(names.materials);
      film.thickness =
          mapping_of_film.required("thickness", "the film's thickness").number(Dimension::length, positive, 0);
      film.base = mapping_of_film.required("base", "the material below the film").reference(names.materials);
      film.stretch = mapping_of_film.optional("stretch").number(Dimension::number, proportion, 0);
      film.crop = read_region(mapping_of_film.optional("crop"));
      scene.films.push_back(std::move(film));
    }
  skin.extrapolation = mapping.optional("extrapolation").number(Dimension::length, positive, skin.extrapolation);
}

static void add_landmark(const SceneLandmark& landmark, const Node& entry, Scene& scene)
{
  if (std::any_of(scene.landmarks.begin(), scene.landmarks.end(),
                  [&](const SceneLandmark& other) { return other.name == landmark.name; }))
    entry.fault("'{}' is a landmark already; name those of a head that are meant in 'only'", landmark.name);
  else
    scene.landmarks.push_back(landmark);
}

/// Adds a set of landmarks of a head, given as {each: SET OF SURFACES, set: NAME, only: [NAME, …]}.
static void read_head_landmarks(const Node& entry, Scene& scene, const SceneNames& names)
{
  Mapping mapping(entry);
  Names heads{ "set of parts of a head", {}, names.surfaces.complete };
  heads.names.reserve(names.heads.size());
  for (const auto& [name, shape] : names.heads)
    heads.names.push_back(name);
  const std::string of = mapping.optional("each").reference(heads);
  const Node set = mapping.optional("set"), only = mapping.optional("only");
  if (!heads.has(of))
    return;
  SceneLandmark landmark;
  landmark.line = entry.line();
  landmark.head = names.heads.at(of);
  const auto& sets = landmark.head->head->points;
  std::vector<std::string> known;
  known.reserve(sets.size());
  for (const auto& [name, points] : sets)
    known.push_back(name);
  const std::string chosen = set.given() ? set.choice(known) : "anthropometric";
  if (sets.count(chosen) == 0)
    return;
  Names points{ "landmark", {}, true };
  points.names.reserve(sets.at(chosen).size());
  for (const auto& point : sets.at(chosen))
    points.names.push_back(point.name);
  const std::vector<std::string> wanted = only.given() ? only.references(points) : points.names;
  for (const auto& point : sets.at(chosen))
    if (std::find(wanted.begin(), wanted.end(), point.name) != wanted.end())
    {
      landmark.name = point.name;
      landmark.point = point;
      add_landmark(landmark, entry, scene);
    }
}

void read_landmarks(const Node& node, Scene& scene, const SceneNames& names)
{
  for (const auto& [name, entry] : node.named_pairs())
  {
    if (entry.has("each"))
    {
      read_head_landmarks(entry, scene, names);
      continue;
    }
    SceneLandmark landmark;
    landmark.name = name;
    landmark.line = entry.line();
    landmark.position = entry.vector(Dimension::length, any_number, landmark.position);
    add_landmark(landmark, entry, scene);
  }
}

void read_joints(const Node& node, Scene& scene, const SceneNames& names)
{
  for (const auto& [bone, entry] : node.named_pairs())
  {
    entry.check_known(bone, names.bones);
    scene.joints.push_back({ bone, read_joint(entry), {} });
  }
  for (const auto& [set, shape] : names.heads)
    for (const auto& [bone, joint] : shape.head->joints)
      if (names.bones.has(bone) && !node.has(bone))
        scene.joints.push_back({ bone, joint, shape });
}

void read_time(const Node& node, SceneTime& time)
{
  if (!node.given())
    return;
  Mapping mapping(node);
  time.damping = mapping.optional("damping").number(Dimension::rate, not_negative, time.damping);
  time.scaling = mapping.optional("scaling").number(Dimension::number, at_least_one, time.scaling);
  time.frame_rate =
      mapping.optional("frame_rate").number(Dimension::rate, Bound{ 0.1, 1000, true, true }, time.frame_rate);
  time.activation_slew =
      mapping.optional("activation_slew").number(Dimension::rate, not_negative, time.activation_slew);
}

void read_effects(const Node& node, Scene& scene)
{
  if (!node.given())
    return;
  Mapping mapping(node);
  EffectSet present = EffectSet::all();
  const bool has_friction =
      std::any_of(scene.constraints.begin(), scene.constraints.end(),
                  [](const SceneConstraint& constraint)
                  { return constraint.kind == SceneConstraint::Kind::sliding && constraint.friction > 0; });
  present = present.with(Effect::friction, has_friction);
  for (const Effect effect : every_effect())
    if (const Node entry = mapping.optional(name_of(effect)); entry.given())
      scene.switched_off = scene.switched_off.with(effect, entry.choice({ "on", "off" }) == "off");
  try
  {
    check_switched_off(scene.switched_off, present);
  }
  catch (const Error& error)
  {
    node.fault(error.what());
  }
}

}  // namespace frontalis
