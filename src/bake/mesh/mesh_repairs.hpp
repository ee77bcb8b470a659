#pragma once

#include "bake/mesh/mesh_faults.hpp"

namespace frontalis
{

/// What was repaired in a mesh without changing its shape: numbers of triangles, and of pieces.
struct MeshRepairs
{
  std::size_t collapsed = 0;     ///< removed: a corner twice
  std::size_t repeated = 0;      ///< removed: there twice
  std::size_t back_to_back = 0;  ///< pairs removed, which enclose nothing
  std::size_t flat = 0;          ///< removed: without area, the neighbour split instead
  std::size_t turned = 0;        ///< turned to agree with their neighbours
};

/// Joins vertices and makes these repairs.
MeshRepairs repair_mesh(TriangleMesh& mesh);

/// Turns the pieces of a closed mesh that are inside-out: beyond whose outer side the winding number is -1. Returns
/// their number; `nested` receives that of pieces that face outwards inside others.
std::size_t turn_inside_out_pieces(TriangleMesh& mesh, const std::vector<std::int32_t>& piece, std::size_t& nested);

}  // namespace frontalis
