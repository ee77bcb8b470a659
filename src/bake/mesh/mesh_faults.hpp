#pragma once

#include "bake/mesh/surface_mesh.hpp"

#include <vector>

namespace frontalis
{

/// Faults of a mesh whose equal vertices are joined and whose neighbouring triangles are oriented alike.
struct MeshFaults
{
  struct Kind
  {
    std::size_t count = 0;
    Vector3d place{ 0, 0, 0 };  ///< of the first; of crossings: the middle of the widest group [m]
  };
  struct Hole
  {
    double length = 0;  ///< of its rim [m]
    Vector3d centre{ 0, 0, 0 };
  };

  Kind fins;       ///< edges of three or more triangles, not as many one way as the other: the inside is undecided
  Kind touching;   ///< edges of four or more triangles, as many one way as the other: bodies that touch
  Kind flat;       ///< triangles without area
  Kind slivers;    ///< triangles whose height is less than a fiftieth of their longest edge
  Kind crossings;  ///< pairs of triangles that cross
  double crossing_extent = 0;        ///< box diagonal of the widest connected group of crossing triangles [m]
  std::vector<Hole> holes;           ///< longest first
  std::vector<std::int32_t> piece;   ///< of each triangle: number of the part of the mesh connected by edges
  std::vector<bool> crossing_piece;  ///< of each piece: whether a triangle of it crosses another
};

/// By CGAL's Polygon Mesh Processing, which decides by exact predicates.
MeshFaults find_mesh_faults(const TriangleMesh& mesh);

std::vector<MeshFaults::Hole> find_holes(const TriangleMesh& mesh);

}  // namespace frontalis
