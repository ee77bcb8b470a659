#include "scene/sections.hpp"

namespace frontalis
{
namespace
{

const std::vector<std::string> laws{ "neo_hookean", "mooney_rivlin", "ogden", "fung", "holzapfel", "guccione" };

// two directions of the fibre families
void read_families(const Node& node, std::array<Vector3, 2>& families)
{
  const std::vector<Node> entries = node.entries();
  if (node.is_list() && entries.size() != families.size())
    node.fault("found " + std::to_string(entries.size()) + " directions; must be two");
  for (std::size_t f = 0; f < entries.size() && f < families.size(); ++f)
    families[f] = entries[f].direction({ 1, 0, 0 });
}

// terms of a Prony series
void read_viscosity(const Node& node, std::vector<SceneMaterial::ViscousTerm>& terms)
{
  const std::vector<Node> entries = node.entries();
  if (entries.size() > 2)
    node.fault("found " + std::to_string(entries.size()) + " terms; must be one or two");
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
    node.fault("the shares add up to " + std::to_string(sum) +
               "; must stay below 1, or nothing is left of the stiffness");
}

// the law's parameters, in SI units; a law more is a branch more
void read_parameters(const std::string& law, Mapping& mapping, const SceneNames& names, SceneMaterial& material)
{
  const auto read = [&](const std::string& key, const std::string& what, Dimension dimension, const Bound& bound)
  { material.parameters[key] = mapping.required(key, what).number(dimension, bound, 0); };
  const auto pressure = [&](const std::string& key, const std::string& what, const Bound& bound = positive)
  { read(key, what, Dimension::pressure, bound); };
  const auto number = [&](const std::string& key, const std::string& what, const Bound& bound)
  { read(key, what, Dimension::number, bound); };
  if (law == "neo_hookean")
    pressure("young", "Young's modulus, greater than 0");
  else if (law == "mooney_rivlin")
  {
    pressure("c1", "a pressure greater than 0");
    pressure("c2", "a pressure of at least 0", not_negative);
  }
  else if (law == "ogden")
  {
    for (const std::string term : { "1", "2" })
    {
      pressure("mu" + term, "a pressure", any_number);
      number("alpha" + term, "an exponent", any_number);
      if (material.parameters["alpha" + term] == 0 && mapping.has("alpha" + term))
        mapping.optional("alpha" + term).fault("found '0'; must not be 0");
    }
    const auto& p = material.parameters;
    if (mapping.has("mu1") && !(p.at("mu1") * p.at("alpha1") + p.at("mu2") * p.at("alpha2") > 0))
      mapping.optional("mu1").fault(
          "mu1 alpha1 + mu2 alpha2 is not greater than 0; must be, it is twice the shear modulus at rest");
  }
  else if (law == "fung")
  {
    pressure("shear", "shear modulus at rest, greater than 0");
    number("b", "a number greater than 0", positive);
  }
  else if (law == "holzapfel")
  {
    pressure("shear", "shear modulus of the matrix, greater than 0");
    pressure("k1", "a pressure of at least 0", not_negative);
    number("k2", "a number greater than 0", positive);
    number("dispersion", "a number from 0 to 1/3", Bound{ 0, 1.0 / 3, true, true });
    read_families(mapping.required("families", "two directions"), material.families);
    if (const Node along = mapping.optional("along"); along.given())
    {
      material.along = along.reference(names.surfaces);
      const auto& [a, b] = material.families;
      const double cosine = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
      if (cosine * cosine > 0.9999)
        along.fault("the two families have the same direction; along a surface they must span a plane");
    }
  }
  else if (law == "guccione")
  {
    pressure("c", "a pressure greater than 0");
    for (const std::string b : { "bf", "bt", "bfs" })
      number(b, "a number greater than 0", positive);
    material.families[0] = mapping.required("fibre", "a direction").direction({ 1, 0, 0 });
  }
  number("poisson", "Poisson's ratio, greater than -1 and less than 0.5", Bound{ -1, 0.5, false, false });
}

}  // namespace

void read_materials(const Node& node, Scene& scene, SceneNames& names)
{
  names.materials.complete = node.is_mapping();
  for (const auto& [name, entry] : node.named_pairs())
  {
    SceneMaterial material;
    material.name = name;
    material.line = entry.line();
    names.materials.names.push_back(name);
    {
      Mapping mapping(entry);
      const Node law = mapping.optional("law");
      if (law.given())
        material.law = law.choice(laws);
      if (material.law.empty())
        mapping.ignore_rest();
      else
      {
        read_parameters(material.law, mapping, names, material);
        read_viscosity(mapping.optional("viscosity"), material.viscosity);
        material.density =
            mapping.required("density", "a density greater than 0").number(Dimension::density, positive, 0);
      }
    }
    scene.materials.push_back(material);
  }
}

}  // namespace frontalis
