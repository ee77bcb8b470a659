#include "sections.hpp"

namespace frontalis
{
namespace
{

// the law's parameters, in SI units; a law more is a branch more
void read_parameters(const std::string& law, Mapping& mapping, SceneMaterial& material)
{
  if (law == "neo_hookean")
  {
    material.parameters["young"] =
        mapping.required("young", "Young's modulus, greater than 0").number(Dimension::pressure, positive, 0);
    material.parameters["poisson"] = mapping.required("poisson", "Poisson's ratio, greater than -1 and less than 0.5")
                                         .number(Dimension::number, Bound{ -1, 0.5, false, false }, 0);
  }
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
        material.law = law.choice({ "neo_hookean" });
      if (material.law.empty())
        mapping.ignore_rest();
      else
      {
        read_parameters(material.law, mapping, material);
        material.density =
            mapping.required("density", "a density greater than 0").number(Dimension::density, positive, 0);
      }
    }
    scene.materials.push_back(material);
  }
}

}  // namespace frontalis
