#include "scene/sections.hpp"

namespace frontalis
{
namespace
{

void read_displacement(const Node& node, SceneLoad& load)
{
  const auto components = node.open_vector(Dimension::length);
  if (!components)
    return;
  for (std::size_t i = 0; i < 3; ++i)
  {
    load.fixed[i] = (*components)[i].has_value();
    load.value[i] = (*components)[i].value_or(0);
  }
  if (!load.fixed[0] && !load.fixed[1] && !load.fixed[2])
    node.fault("found null for all three; at least one must be a length");
}

std::optional<ScenePush> read_push(const Node& node)
{
  if (!node.given())
    return {};
  ScenePush push;
  Mapping mapping(node);
  push.mass = mapping.required("mass", "the mass of the body").number(Dimension::mass, positive, push.mass);
  push.force = mapping.optional("force").vector(Dimension::force, any_number, push.force);
  push.spring = mapping.optional("spring").number(Dimension::spring, not_negative, push.spring);
  push.damping = mapping.optional("damping").number(Dimension::drag, not_negative, push.damping);
  return push;
}

}  // namespace

void read_constraints(const Node& node, Scene& scene, SceneNames& names)
{
  const auto read = [&](const Node& entry, Mapping& mapping, SceneConstraint& constraint)
  {
    const std::string kind = one_of(entry, mapping, { "rigid", "sliding", "contact" });
    if (kind.empty())
      return;
    using Kind = SceneConstraint::Kind;
    constraint.kind = kind == "rigid" ? Kind::rigid : kind == "sliding" ? Kind::sliding : Kind::contact;
    constraint.surfaces = mapping.optional(kind).references(names.surfaces);
    if (constraint.kind == Kind::contact)
    {
      constraint.on = mapping.optional("on").reference(names.surfaces);
      constraint.pushed = read_push(mapping.optional("pushed"));
    }
    else
      constraint.within = mapping.optional("within").number(Dimension::length, positive, constraint.within);
    constraint.crop = read_region(mapping.optional("crop"));
    if (const Node bone = mapping.optional("bone"); bone.given())
      names.bones.names.push_back(constraint.bone = bone.name());
    if (constraint.kind != Kind::rigid)
      constraint.friction = mapping.optional("friction").number(Dimension::number, not_negative, constraint.friction);
  };
  read_list(node, scene.constraints, read);
  names.bones.complete = !node.faulty();
}

void read_loads(const Node& node, Scene& scene, const SceneNames& names)
{
  using Kind = SceneLoad::Kind;
  const std::map<std::string, Kind> kinds{ { "traction", Kind::traction },
                                           { "pressure", Kind::pressure },
                                           { "displacement", Kind::displacement } };
  const auto read = [&](const Node& entry, Mapping& mapping, SceneLoad& load)
  {
    const std::string kind = one_of(entry, mapping, { "traction", "pressure", "displacement" });
    if (kind.empty())
      return;
    load.kind = kinds.at(kind);
    const Node value = mapping.optional(kind);
    if (load.kind == Kind::traction)
      load.value = value.vector(Dimension::pressure, any_number, load.value);
    else if (load.kind == Kind::pressure)
      load.value[0] = value.number(Dimension::pressure, any_number, 0);
    else
    {
      read_displacement(value, load);
      load.within = mapping.optional("within").number(Dimension::length, positive, load.within);
    }
    load.surface = mapping.required("surface", "the name of a surface").reference(names.surfaces);
    load.ramp = mapping.optional("ramp").number(Dimension::time, not_negative, load.ramp);
    load.crop = read_region(mapping.optional("crop"));
  };
  read_list(node, scene.loads, read);
}

}  // namespace frontalis
