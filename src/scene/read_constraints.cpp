#include "scene/sections.hpp"

#include <utility>

namespace frontalis
{
namespace
{

// exactly one of `keys` must be there: returns it, or records a fault and returns an empty text
std::string one_of(const Node& entry, const Mapping& mapping, const std::vector<std::string>& keys)
{
  std::vector<std::string> there;
  std::string all;
  for (const std::string& key : keys)
  {
    all += (all.empty() ? "" : ", ") + key;
    if (mapping.has(key))
      there.push_back(key);
  }
  if (there.size() == 1)
    return there[0];
  if (entry.is_mapping())
    entry.fault("found {} of {}; must have exactly one", there.empty() ? "none" : fmt::format("{}", there.size()), all);
  return {};
}

double read_within(const Node& node, double fallback) { return node.number(Dimension::length, positive, fallback); }

}  // namespace

void read_constraints(const Node& node, Scene& scene, const SceneNames& names)
{
  std::vector<std::string> earlier;
  for (const Node& entry : node.entries())
  {
    SceneConstraint constraint;
    constraint.line = entry.line();
    Mapping mapping(entry);
    constraint.name = read_unique_name(mapping, earlier);
    const std::string kind = one_of(entry, mapping, { "rigid", "sliding", "contact" });
    if (kind.empty())
    {
      mapping.ignore_rest();
      continue;
    }
    using Kind = SceneConstraint::Kind;
    constraint.kind = kind == "rigid" ? Kind::rigid : kind == "sliding" ? Kind::sliding : Kind::contact;
    constraint.surfaces = mapping.optional(kind).references(names.surfaces);
    if (constraint.kind == Kind::contact)
      constraint.on = mapping.optional("on").reference(names.surfaces);
    else
      constraint.within = read_within(mapping.optional("within"), constraint.within);
    constraint.crop = read_region(mapping.optional("crop"));
    constraint.bone = mapping.optional("bone").name();
    if (constraint.kind != Kind::rigid)
      constraint.friction = mapping.optional("friction").number(Dimension::number, not_negative, constraint.friction);
    scene.constraints.push_back(constraint);
  }
}

void read_loads(const Node& node, Scene& scene, const SceneNames& names)
{
  std::vector<std::string> earlier;
  for (const Node& entry : node.entries())
  {
    SceneLoad load;
    load.line = entry.line();
    Mapping mapping(entry);
    load.name = read_unique_name(mapping, earlier);
    const std::string kind = one_of(entry, mapping, { "traction", "pressure", "displacement" });
    if (kind.empty())
    {
      mapping.ignore_rest();
      continue;
    }
    const Node value = mapping.optional(kind);
    if (kind == "traction")
    {
      load.kind = SceneLoad::Kind::traction;
      load.value = value.vector(Dimension::pressure, any_number, load.value);
    }
    else if (kind == "pressure")
    {
      load.kind = SceneLoad::Kind::pressure;
      load.value[0] = value.number(Dimension::pressure, any_number, 0);
    }
    else
    {
      load.kind = SceneLoad::Kind::displacement;
      if (const auto components = value.open_vector(Dimension::length))
      {
        for (std::size_t i = 0; i < 3; ++i)
        {
          load.fixed[i] = (*components)[i].has_value();
          load.value[i] = (*components)[i].value_or(0);
        }
        if (!load.fixed[0] && !load.fixed[1] && !load.fixed[2])
          value.fault("found null for all three; at least one must be a length");
      }
      load.within = read_within(mapping.optional("within"), load.within);
    }
    load.surface = mapping.required("surface", "the name of a surface").reference(names.surfaces);
    load.ramp = mapping.optional("ramp").number(Dimension::time, not_negative, load.ramp);
    load.crop = read_region(mapping.optional("crop"));
    scene.loads.push_back(load);
  }
}

}  // namespace frontalis
