#pragma once

#include "frontalis/scene/geometry.hpp"
#include "bake/mesh/surface_mesh.hpp"

#include <string>
#include <vector>

namespace frontalis
{

struct LoadedSurface
{
  TriangleMesh mesh;                  ///< joined, oriented, scene coordinates [m]
  std::vector<std::string> findings;  ///< what was repaired, and what is harmless, one sentence each
};

/// Makes or reads a surface, repairs what can be repaired without changing its shape, and looks for what is left;
/// places in messages are in `unit` [m]. Throws Error, with the place and the remedy, for: no triangle with an area, an
/// edge that three triangles share and nothing says which side is inside, a surface that encloses nothing because it is
/// flat, one that passes through itself. Holes are data here: see check_openings.
///
/// A surface passes through itself where more than a fiftieth of what it encloses is enclosed twice, or where that
/// reaches deeper than a twenty-fifth of its size (the cube root of what it encloses); and, if it is open, where
/// triangles that cross hang together over more than a twentieth of its extent. Of the 42 meshes of a real head,
/// segmented from images, most cross themselves somewhere: two cartilages enclose 0.6 % twice, 0.26 mm or 1.7 % of
/// their size deep, the others nothing that 200,000 points would find; the open skin crosses itself over 1.8 % of its
/// extent.
LoadedSurface load_surface(const Surface& surface, double unit);

}  // namespace frontalis
