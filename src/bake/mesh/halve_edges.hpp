#pragma once

#include "bake/mesh/surface_mesh.hpp"

namespace frontalis
{

/// Halves edges that are longer than longest(middle) [m], the longest ones first, so that angles stay bounded (Rivara
/// 1984). New vertices follow the old ones and lie on a smooth surface (curved_middle()). Returns, for each new vertex,
/// the ends of the edge that it halves.
std::vector<std::array<std::int32_t, 2>> halve_edges(TriangleMesh& mesh,
                                                     const std::function<double(const Vector3d&)>& longest);

}  // namespace frontalis
