#include "scene/sections.hpp"

#include "frontalis/physics/materials/lookup.hpp"
#include "frontalis/physics/number.hpp"

#include <filesystem>

namespace frontalis
{
namespace
{

std::vector<std::string> names_of_laws()
{
  std::vector<std::string> names;
  names.reserve(physics::material_table.size());
  for (const auto& description : physics::material_table)
    names.emplace_back(description.name);
  return names;
}

void read_families(const Node& node, std::array<Vector3, 2>& families)
{
  const std::vector<Node> entries = node.entries();
  if (node.is_list() && entries.size() != families.size())
    node.fault("found {} directions; must be two", entries.size());
  for (std::size_t f = 0; f < entries.size() && f < families.size(); ++f)
    families[f] = entries[f].direction({ 1, 0, 0 });
}

void read_viscosity(const Node& node, std::vector<SceneMaterial::ViscousTerm>& terms)
{
  const std::vector<Node> entries = node.entries();
  if (entries.size() > 2)
    node.fault("found {} terms; must be one or two", entries.size());
  double sum = 0;
  for (const Node& entry : entries)
  {
    Mapping mapping(entry);
    SceneMaterial::ViscousTerm term;
    term.share =
        mapping.required("share", "a share from 0 to 1").number(Dimension::number, Bound{ 0, 1, false, false }, 0);
    term.time = mapping.required("time", "a time greater than 0").number(Dimension::time, positive, 0);
    sum += term.share;
    terms.push_back(term);
  }
  if (!(sum < 1))
    node.fault("the shares add up to {}; must stay below 1, because the rest is the stiffness at rest", sum);
}

double read_parameter(const physics::Parameter& parameter, Mapping& mapping)
{
  const bool number = parameter.measure == physics::Measure::number;
  const physics::Range& range = parameter.range;
  const Bound bound{ range.lower, range.upper, range.lower_allowed, range.upper_allowed };
  const std::string limits = range.zero_allowed ? bound.text() : "other than 0";
  const Node node = parameter.optional
                        ? mapping.optional(parameter.key)
                        : mapping.required(parameter.key, fmt::format("{}, {}{}{}", parameter.meaning,
                                                                      number ? "a number" : "a pressure",
                                                                      limits.empty() ? "" : " ", limits));
  const double value = node.number(number ? Dimension::number : Dimension::pressure, bound, 0);
  if (node.given() && value == 0 && !range.zero_allowed && !node.faulty())
    node.fault("found '0'; must not be 0");
  return value;
}

// Reads one fibre direction, or the directions of two fibre families, which may follow a surface and a muscle.
void read_directions(int count, Mapping& mapping, const SceneNames& names, SceneMaterial& material)
{
  if (count == 1)
    material.families[0] = mapping.required("fibre", "a direction").direction({ 1, 0, 0 });
  if (count != 2)
    return;
  const Node families = mapping.required("families", "two directions, or {about: MUSCLE, angle: ANGLE}");
  if (families.is_mapping())
  {
    Mapping about(families);
    material.about = about.required("about", "a muscle").text();  // muscles are read later: see check_tissues()
    material.angle = about.required("angle", "an angle from 0 to 90 degrees")
                         .number(Dimension::angle, Bound{ 0, 0.5 * physics::pi, true, true }, 0);
    material.along =
        mapping.required("along", "the surface to which the fibres are parallel").reference(names.surfaces);
    return;
  }
  read_families(families, material.families);
  if (const Node along = mapping.optional("along"); along.given())
  {
    material.along = along.reference(names.surfaces);
    const auto& [a, b] = material.families;
    const double cosine = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    if (cosine * cosine > 0.9999)
      along.fault("the two families have the same direction; along a surface they must span a plane");
  }
}

// Reads the parameters [SI units] and directions of the law.
void read_law(Law law, const Node& node, Mapping& mapping, const SceneNames& names, SceneMaterial& material)
{
  const physics::MaterialDescription& description = physics::description_of(law);
  std::array<double, physics::law_parameters_max> values{};
  for (int p = 0; p < description.count(); ++p)
  {
    const physics::Parameter& parameter = description.parameters[p];
    material.parameters[parameter.key] = values[p] = read_parameter(parameter, mapping);
  }
  read_directions(description.directions, mapping, names, material);
  const double poisson = mapping.required("poisson", "Poisson's ratio, greater than -1 and less than 0.5")
                             .number(Dimension::number, Bound{ -1, 0.5, false, false }, 0);
  material.parameters["poisson"] = poisson;
  if (node.faulty())
    return;
  if (const double shear = physics::shear_modulus_of(law, physics::numbers_of(law, values, poisson)); !(shear > 0))
    node.fault("the shear modulus at rest, {}, is {} Pa; must be greater than 0", description.shear_modulus, shear);
}

}  // namespace

void read_materials(const Node& tissues, const Node& node, Scene& scene, SceneNames& names)
{
  // A library may name surfaces that this scene lacks in materials that it does not use: see check_tissues().
  SceneNames known_names = names;
  const auto read = [&](const Node& entry, Mapping& mapping, SceneMaterial& material)
  {
    const Node law = mapping.optional("law");
    if (law.given())
      material.law = law.choice(names_of_laws());
    const auto known = physics::law_named(material.law);
    if (!known)
      return mapping.ignore_rest();
    read_law(*known, entry, mapping, known_names, material);
    read_viscosity(mapping.optional("viscosity"), material.viscosity);
    material.tension = mapping.optional("tension").number(Dimension::pressure, positive, 0);
    material.density = mapping.required("density", "a density greater than 0").number(Dimension::density, positive, 0);
  };
  std::vector<SceneMaterial> library;
  if (tissues.given() && !tissues.text().empty())
  {
    const std::string path = (std::filesystem::path(scene.file).parent_path() / tissues.text()).string();
    const YAML::Node yaml = load_yaml(path, "tissues", "a mapping of materials");
    ReadingContext context{ Faults(path), node.context().length_unit };
    Names known{ "material", {}, true };
    known_names.surfaces.complete = false;
    read_named(Node(yaml, "", 1, context), library, known, read);
    known_names = names;
    if (!context.faults.empty())
      throw Error(context.faults.text());
  }
  read_named(node, scene.materials, names.materials, read);
  for (SceneMaterial& material : library)
    if (!names.materials.has(material.name))
    {
      material.of_library = true;
      names.materials.names.push_back(material.name);
      scene.materials.push_back(material);
    }
  if (tissues.given() && !node.given())
    names.materials.complete = true;
}

}  // namespace frontalis
