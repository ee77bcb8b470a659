#pragma once

#include "frontalis/scene/geometry.hpp"
#include "bake/mesh/surface_mesh.hpp"

#include <string>
#include <vector>

namespace frontalis
{

struct LoadedSurface
{
  TriangleMesh mesh;                  ///< vertices joined, triangles oriented, scene coordinates [m]
  std::vector<std::string> findings;  ///< repairs and harmless faults, one sentence each
};

/// Makes or reads a surface and repairs what can be repaired without changing its shape. `unit` [m] is the length unit
/// of the places in messages. Throws Error, with the place and the remedy, for a surface without a triangle that has an
/// area, an edge at which an odd number of triangles meet, a closed surface that encloses nothing, and a surface that
/// passes through itself. Holes are no error here: check_openings decides whether they do harm.
LoadedSurface load_surface(const Surface& surface, double unit);

}  // namespace frontalis
