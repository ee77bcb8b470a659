#pragma once

#include "bake/mesh/surface_mesh.hpp"

namespace frontalis
{

/// Meshes the same surface anew, with edges of similar length, on average `edge` [m] (Botsch & Kobbelt, A remeshing
/// approach to multiresolution modeling, SGP 2004). Keeps the orientation and, roughly, the borders.
TriangleMesh with_equal_edges(const TriangleMesh& mesh, double edge);

}  // namespace frontalis
