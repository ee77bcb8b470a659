#pragma once

#include "bake/vector.hpp"
#include "frontalis/model/surface.hpp"

#include <functional>

namespace frontalis
{

using Triangle = std::array<std::int32_t, 3>;

inline Vector3d vertex(const TriangleMesh& mesh, std::int32_t v) { return to_vector(mesh.vertices[v]); }
inline std::array<Vector3d, 3> corners(const TriangleMesh& mesh, const Triangle& t)
{
  return { vertex(mesh, t[0]), vertex(mesh, t[1]), vertex(mesh, t[2]) };
}

/// Adds the vertices and triangles of `part`, which are reversed if `flipped`.
void append(TriangleMesh& mesh, const TriangleMesh& part, bool flipped = false);

/// Edges along which the triangles do not run equally often in both directions (borders of holes, seams). Each edge has
/// the direction of its surplus triangles and occurs once for each of them.
using Edges = std::vector<std::array<std::int32_t, 2>>;

Edges unbalanced_edges(const TriangleMesh& mesh);

/// Volume enclosed by a closed mesh [m3], negative if it is inside-out.
double signed_volume(const TriangleMesh& mesh);

/// Area of all triangles [m2].
double surface_area(const TriangleMesh& mesh);

Box bounding_box(const TriangleMesh& mesh);

/// Unit normal of each vertex: the sum of its triangles' normals weighted by their areas; 0 for one without triangles.
std::vector<Vector3d> vertex_normals(const TriangleMesh& mesh);

/// Joins vertices at the same place, in order of first use, and drops triangles that have a vertex twice. Returns the
/// number of triangles dropped.
std::size_t join_vertices(TriangleMesh& mesh);

/// Flips triangles until neighbours are oriented alike. In each connected component the majority of the triangles keeps
/// its orientation. Returns the number of triangles flipped.
std::size_t make_orientation_consistent(TriangleMesh& mesh);

void flip(TriangleMesh& mesh);

/// The triangles with a true entry in `keep` and the vertices that they use, in the same order. `vertex_of` receives
/// the old number of each vertex.
TriangleMesh keep_triangles(const TriangleMesh& mesh, const std::vector<bool>& keep,
                            std::vector<std::int32_t>* vertex_of = nullptr);

/// The part of a mesh inside a region. Triangles that extend beyond the region are cut at its sides. Neighbours share
/// the new vertices, which follow the old ones in the list.
TriangleMesh cut_mesh(const TriangleMesh& mesh, const Region& region);

/// The mesh and a strip along its border that continues each triangle there in its own plane, by half the extent of
/// boxes of that size [m] in its direction. A closed mesh stays as it is.
TriangleMesh continued(TriangleMesh mesh, const Vector3d& box_size);

/// Adds a rectangular sheet of points at(i, j), i in 0..n, j in 0..m, as triangles whose normal is d/di x d/dj.
/// If n is even, diagonals are mirrored about the middle column, so that a symmetric sheet has symmetric triangles.
void add_sheet(TriangleMesh& mesh, std::int32_t n, std::int32_t m,
               const std::function<Vector3d(std::int32_t, std::int32_t)>& at);

}  // namespace frontalis
