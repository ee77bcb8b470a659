#pragma once

#include "frontalis/model/model.hpp"
#include "bake/vector.hpp"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace frontalis
{

using Triangle = std::array<std::int32_t, 3>;

/// Edges that triangles leave unbalanced (a hole's rim, a seam): directed as the triangles have them, with
/// multiplicity.
using Edges = std::vector<std::array<std::int32_t, 2>>;

Edges unbalanced_edges(const TriangleMesh& mesh);

/// Volume enclosed by a closed mesh [m3], negative where it is inside-out.
double signed_volume(const TriangleMesh& mesh);

Box bounding_box(const TriangleMesh& mesh);

/// Joins vertices at the same place, in order of first use, and drops triangles that have a vertex twice. Returns the
/// number of triangles dropped.
std::size_t join_vertices(TriangleMesh& mesh);

/// Turns triangles so that neighbours agree, component by component (the larger part of a component keeps its
/// orientation). Returns the number of triangles turned.
std::size_t make_orientation_consistent(TriangleMesh& mesh);

void flip(TriangleMesh& mesh);

/// The triangles that `keep` accepts, without unused vertices, the order kept; `vertex_of` receives old vertex numbers.
TriangleMesh keep_triangles(const TriangleMesh& mesh, const std::vector<bool>& keep,
                            std::vector<std::int32_t>* vertex_of = nullptr);

}  // namespace frontalis
