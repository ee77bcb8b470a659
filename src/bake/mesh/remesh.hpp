#pragma once

#include "bake/mesh/surface_mesh.hpp"

namespace frontalis
{

/// Meshes the same surface anew, with edges of similar length, on average `edge` [m] (Botsch & Kobbelt, A remeshing
/// approach to multiresolution modeling, SGP 2004). Keeps the orientation and, roughly, the borders.
TriangleMesh with_equal_edges(const TriangleMesh& mesh, double edge);

/// The same surface of fewer triangles, where it is flat (Garland & Heckbert, Surface simplification using quadric
/// error metrics, SIGGRAPH 1997). Its vertices are at most `tolerance` [m] from the planes of the triangles that it
/// replaces. Keeps the orientation and the edges of borders.
TriangleMesh with_fewer_triangles(const TriangleMesh& mesh, double tolerance);

}  // namespace frontalis
