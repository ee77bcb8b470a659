#pragma once

#include "bake/mesh/surface_mesh.hpp"

#include <functional>

namespace frontalis
{

/// Adds a rectangular sheet of points at(i, j), i in 0..n, j in 0..m, as triangles whose normal is d/di x d/dj.
/// Diagonals are mirrored about the middle column where n is even, so that a symmetric sheet has symmetric triangles.
void add_sheet(TriangleMesh& mesh, std::int32_t n, std::int32_t m,
               const std::function<Vector3d(std::int32_t, std::int32_t)>& at);

}  // namespace frontalis
