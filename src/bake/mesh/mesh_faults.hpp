#pragma once

#include "bake/mesh/surface_mesh.hpp"

#include <vector>

namespace frontalis
{

/// What is wrong in a mesh whose equal vertices are joined and whose triangles agree with their neighbours.
struct MeshFaults
{
  /// How many, and where the first (of crossings: the middle of the widest group) is [m].
  struct Kind
  {
    std::size_t count = 0;
    Vector3 place{ 0, 0, 0 };
  };
  struct Hole
  {
    double length = 0;  ///< around it [m]
    Vector3 centre{ 0, 0, 0 };
  };

  Kind fins;       ///< edges of three or more triangles that do not cancel: nothing says which side is inside
  Kind touching;   ///< edges of four or more triangles that do cancel: bodies that touch
  Kind flat;       ///< triangles without area
  Kind slivers;    ///< triangles whose height is less than a fiftieth of their longest edge
  Kind crossings;  ///< pairs of triangles that cross
  double crossing_extent = 0;        ///< diagonal of the widest group of crossing triangles that hang together [m]
  std::vector<Hole> holes;           ///< longest first
  std::vector<std::int32_t> piece;   ///< of each triangle: pieces hang together by edges
  std::vector<bool> crossing_piece;  ///< of each piece: whether any of its triangles cross others
};

/// Finds them with CGAL (Polygon mesh processing), which decides by exact predicates.
MeshFaults find_mesh_faults(const TriangleMesh& mesh);

/// The holes alone.
std::vector<MeshFaults::Hole> find_holes(const TriangleMesh& mesh);

}  // namespace frontalis
