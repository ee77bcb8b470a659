#pragma once

#include "bake/mesh/surface_mesh.hpp"

namespace frontalis
{

/// Divides triangles with an edge longer than longest(middle) [m] into four by halving their edges, the longest ones
/// first, and their neighbours as needed (four-triangle longest-edge partition, Rivara 1984): angles stay bounded, and
/// regular meshes stay regular. New vertices follow the old ones and lie on a smooth surface (curved_middle()).
/// Returns, for each new vertex, the ends of the edge that it halves.
std::vector<std::array<std::int32_t, 2>> halve_edges(TriangleMesh& mesh,
                                                     const std::function<double(const Vector3d&)>& longest);

/// The part of a surface in a box. Because only vertices touch bodies and carry loads, triangles are halved until no
/// edge is longer than `longest` [m]. Both triangles at an edge are halved at the same point.
TriangleMesh refined(const TriangleMesh& surface, const Box& box, double longest);

}  // namespace frontalis
