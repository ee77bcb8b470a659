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

void read_within(Mapping& mapping, SceneConstraint& constraint)
{
  constraint.within = mapping.optional("within").number(Dimension::length, positive, constraint.within);
}

void read_place(Mapping& mapping, SceneConstraint& constraint)
{
  constraint.crop = read_region(mapping.optional("crop"));
  constraint.bone = mapping.optional("bone").name();
}

void read_friction(Mapping& mapping, SceneConstraint& constraint)
{
  constraint.friction = mapping.optional("friction").number(Dimension::number, not_negative, constraint.friction);
}

// A kind of constraint: the key for its surfaces, and the function that reads its other keys.
struct ConstraintKind
{
  SceneConstraint::Kind kind;
  const char* key;
  void (*read)(Mapping&, SceneConstraint&, const SceneNames&);
};

constexpr ConstraintKind constraint_kinds[] = {
  { SceneConstraint::Kind::rigid, "rigid",
    [](Mapping& mapping, SceneConstraint& constraint, const SceneNames& names)
    {
      read_within(mapping, constraint);
      if (const Node of = mapping.optional("of"); of.given())
        constraint.of = of.references(names.muscles);
      read_place(mapping, constraint);
    } },
  { SceneConstraint::Kind::sliding, "sliding",
    [](Mapping& mapping, SceneConstraint& constraint, const SceneNames&)
    {
      read_within(mapping, constraint);
      read_place(mapping, constraint);
      read_friction(mapping, constraint);
    } },
  { SceneConstraint::Kind::contact, "contact",
    [](Mapping& mapping, SceneConstraint& constraint, const SceneNames& names)
    {
      constraint.on = mapping.optional("on").reference(names.surfaces);
      read_place(mapping, constraint);
      read_friction(mapping, constraint);
      constraint.pushed = read_push(mapping.optional("pushed"));
    } },
  { SceneConstraint::Kind::self_contact, "self_contact",
    [](Mapping& mapping, SceneConstraint& constraint, const SceneNames&)
    {
      constraint.crop = read_region(mapping.optional("crop"));
      read_friction(mapping, constraint);
    } },
  // a body that is only shown: within its reach of 0 there is no tissue to touch
  { SceneConstraint::Kind::contact, "shown",
    [](Mapping& mapping, SceneConstraint& constraint, const SceneNames&)
    {
      constraint.within = 0;
      constraint.bone = mapping.optional("bone").name();
      constraint.crop = read_region(mapping.optional("crop"));
    } },
};

}  // namespace

void read_constraints(const Node& node, Scene& scene, SceneNames& names)
{
  const auto read = [&](const Node& entry, Mapping& mapping, SceneConstraint& constraint)
  {
    std::vector<std::string> keys;
    for (const ConstraintKind& kind : constraint_kinds)
      keys.emplace_back(kind.key);
    const std::string key = one_of(entry, mapping, keys);
    for (const ConstraintKind& kind : constraint_kinds)
      if (key == kind.key)
      {
        constraint.kind = kind.kind;
        constraint.surfaces = mapping.optional(key).references(names.surfaces);
        kind.read(mapping, constraint, names);
        if (!constraint.bone.empty())
          names.bones.names.push_back(constraint.bone);
      }
  };
  read_list(node, scene.constraints, read);
  names.bones.complete = !node.faulty();
}

void read_loads(const Node& node, Scene& scene, SceneNames& names)
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
    const Node ramp = mapping.optional("ramp"), activated = mapping.optional("activated");
    load.ramp = ramp.number(Dimension::time, not_negative, load.ramp);
    load.activated = activated.boolean(false);
    if (load.activated && load.kind == Kind::displacement)
      activated.fault("goes with traction and pressure, not with displacement");
    if (load.activated && ramp.given())
      ramp.fault("does not go with 'activated'; the activation sets how the load grows");
    if (load.activated && names.muscles.has(load.name))
      activated.fault("there is a muscle '{}'; an activated load needs a name of its own", load.name);
    if (load.activated)
      names.activations.names.push_back(load.name);
    load.crop = read_region(mapping.optional("crop"));
    if (const Node clear_of = mapping.optional("clear_of"); clear_of.given())
    {
      if (load.kind == Kind::displacement)
        clear_of.fault("goes with traction and pressure, not with displacement");
      Mapping clear(clear_of);
      load.clear_of = clear.required("surfaces", "a list of surfaces").references(names.surfaces);
      load.clearance = clear.required("by", "a distance").number(Dimension::length, positive, load.clearance);
    }
  };
  names.activations.names = names.muscles.names;
  read_list(node, scene.loads, read);
  names.activations.complete = names.muscles.complete && !node.faulty();
}

}  // namespace frontalis
