#pragma once

#include "bake/mesh/surface_mesh.hpp"

namespace frontalis
{

/// Faults of a mesh with joined vertices and consistent orientation.
struct MeshFaults
{
  struct Kind
  {
    std::size_t count = 0;
    Vector3d place{ 0, 0, 0 };  ///< position of the first fault; for crossings: middle of the widest group [m]
  };
  struct Hole
  {
    double length = 0;  ///< length of the hole's border [m]
    Vector3d centre{ 0, 0, 0 };
  };

  Kind fins;       ///< edges of three or more triangles, whose directions do not balance: the inside is undefined
  Kind touching;   ///< edges of four or more triangles, whose directions balance: bodies that touch
  Kind flat;       ///< triangles without area
  Kind slivers;    ///< triangles with a height below a fiftieth of their longest edge
  Kind spikes;     ///< vertices that stand out of their neighbours; the place is that of the highest
  Kind crossings;  ///< pairs of triangles that cross
  double spike_height = 0;           ///< of the highest spike [m]
  double crossing_extent = 0;        ///< box diagonal of the widest connected group of crossing triangles [m]
  std::vector<Hole> holes;           ///< longest first
  std::vector<std::int32_t> piece;   ///< for each triangle the index of its edge-connected component
  std::vector<bool> crossing_piece;  ///< for each component whether one of its triangles crosses another
};

/// Uses the exact predicates of CGAL's Polygon Mesh Processing.
MeshFaults find_mesh_faults(const TriangleMesh& mesh);

std::vector<MeshFaults::Hole> find_holes(const TriangleMesh& mesh);

/// Numbers of repaired triangles. Repairs do not change the shape of a mesh.
struct MeshRepairs
{
  std::size_t collapsed = 0;     ///< removed because two corners are the same vertex
  std::size_t repeated = 0;      ///< removed because the same triangle exists already
  std::size_t back_to_back = 0;  ///< pairs of opposite triangles removed, since they enclose nothing
  std::size_t flat = 0;          ///< removed because they have no area; a neighbour is split at the middle vertex
  std::size_t turned = 0;        ///< flipped to agree with their neighbours
};

/// Joins equal vertices and makes the repairs that MeshRepairs lists.
MeshRepairs repair_mesh(TriangleMesh& mesh);

/// Flips the components of a closed mesh that are inside-out (winding number -1 just outside) and returns their number.
/// `nested` receives the number of components that lie inside others and face outwards.
std::size_t turn_inside_out_pieces(TriangleMesh& mesh, const std::vector<std::int32_t>& piece, std::size_t& nested);

}  // namespace frontalis
