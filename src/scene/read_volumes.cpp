#include "scene/sections.hpp"

#include <cmath>

namespace frontalis
{
namespace
{

void read_corner(const Node& node, Vector3& corner)
{
  if (const auto given = node.open_vector(Dimension::length))
    for (std::size_t i = 0; i < 3; ++i)
      corner[i] = (*given)[i].value_or(corner[i]);
}

void read_depth(const Node& node, Volume& volume, const SceneNames& names)
{
  Mapping mapping(node);
  volume.within = mapping.required("surface", "the name of a surface").reference(names.surfaces);
  volume.depth_min = mapping.optional("from").number(Dimension::length, any_number, 0);
  const Node to = mapping.required("to", "a depth greater than 'from'");
  volume.depth_max = to.number(Dimension::length, any_number, std::nan(""));
  if (volume.depth_max <= volume.depth_min)
    to.fault(to.found() + "; must be greater than 'from'");
}

}  // namespace

Region read_region(const Node& node)
{
  Region region;
  if (!node.given())
    return region;
  Mapping mapping(node);
  const Node lower = mapping.optional("lower");
  const Node upper = mapping.optional("upper");
  if (node.is_mapping() && !lower.given() && !upper.given())
    node.fault("found neither 'lower' nor 'upper'; must have at least one of them");
  read_corner(lower, region.lower);
  read_corner(upper, region.upper);
  for (std::size_t i = 0; i < 3; ++i)
    if (region.lower[i] >= region.upper[i])
    {
      node.fault("the {0} of 'lower' must be less than that of 'upper'", "xyz"[i]);
      break;
    }
  return region;
}

void read_volumes(const Node& node, Scene& scene, SceneNames& names)
{
  const auto read = [&](const Node& entry, Mapping& mapping, Volume& volume)
  {
    const Node closed_by = mapping.optional("closed_by");
    const Node inside = mapping.optional("inside");
    const Node within = mapping.optional("within");
    volume.closed_by = closed_by.references(names.surfaces);
    volume.inside = inside.references(names.surfaces);
    volume.outside = mapping.optional("outside").references(names.surfaces);
    volume.without = mapping.optional("without").references(names.surfaces);
    const Node slits = mapping.optional("slits");
    volume.slits = slits.references(names.surfaces);
    if (within.given())
      read_depth(within, volume, names);
    if (entry.is_mapping() && !closed_by.given() && !inside.given() && !within.given())
      entry.fault("found no bound; must have at least one of closed_by, inside, within");

    volume.crop = read_region(mapping.optional("crop"));
    volume.tissue = mapping.optional("tissue").boolean(false);
    if (slits.given() && !volume.tissue)
      slits.fault("found slits in a volume that is not tissue; must be in a volume with 'tissue: true'");
    const Node material = volume.tissue ? mapping.required("material", "the name of a material, as for all tissue")
                                        : mapping.optional("material");
    volume.material = material.reference(names.materials);
    volume.priority = mapping.optional("priority").integer(-1000, 1000, volume.tissue ? 0 : 1);
    if (volume.tissue)
      names.tissue_volumes.names.push_back(volume.name);
  };
  read_named(node, scene.volumes, names.volumes, read);
  names.tissue_volumes.complete = names.volumes.complete && !node.context().faults.any_at(node.path());
  if (names.tissue_volumes.complete && names.tissue_volumes.names.empty())
    node.fault("no volume is tissue; at least one must have 'tissue: true'");
}

void read_layers(const Node& node, Scene& scene, const SceneNames& names)
{
  const auto read = [&](const Node&, Mapping& mapping, Layer& layer)
  {
    layer.surface = mapping.required("surface", "the name of a surface").reference(names.surfaces);
    const Node volume = mapping.required("volume", "the name of a tissue volume");
    layer.volume = volume.reference(names.volumes);
    if (names.volumes.has(layer.volume) && names.tissue_volumes.complete)
      volume.reference(names.tissue_volumes);
    layer.material = mapping.required("material", "the name of a material").reference(names.materials);
    layer.thickness = mapping.required("thickness", "a length").number(Dimension::length, positive, 0);
    layer.shell = mapping.optional("shell").boolean(false);
  };
  read_list(node, scene.layers, read);
}

}  // namespace frontalis
