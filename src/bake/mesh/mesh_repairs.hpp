#pragma once

#include "bake/mesh/mesh_faults.hpp"

namespace frontalis
{

/// Numbers of triangles that were repaired without changing the shape of a mesh.
struct MeshRepairs
{
  std::size_t collapsed = 0;     ///< removed because two corners are the same vertex
  std::size_t repeated = 0;      ///< removed because the same triangle exists already
  std::size_t back_to_back = 0;  ///< pairs removed, which enclose nothing
  std::size_t flat = 0;          ///< removed because they have no area; the neighbour is split instead
  std::size_t turned = 0;        ///< reversed to be oriented as their neighbours
};

/// Joins equal vertices and makes these repairs.
MeshRepairs repair_mesh(TriangleMesh& mesh);

/// Turns the pieces of a closed mesh that are inside-out: the winding number just outside them is -1. Returns how many
/// there were; `nested` receives the number of pieces that lie inside others and face outwards.
std::size_t turn_inside_out_pieces(TriangleMesh& mesh, const std::vector<std::int32_t>& piece, std::size_t& nested);

}  // namespace frontalis
