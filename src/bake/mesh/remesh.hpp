#pragma once

#include "bake/mesh/surface_mesh.hpp"

namespace frontalis
{

/// The same surface in triangles whose edges are `edge` [m] long on average, none much longer or shorter (Botsch &
/// Kobbelt, A remeshing approach to multiresolution modeling, SGP 2004). Keeps the orientation and, roughly, the
/// borders.
TriangleMesh with_equal_edges(const TriangleMesh& mesh, double edge);

}  // namespace frontalis
