#pragma once

#include "bake/mesh/surface_mesh.hpp"

#include <functional>

namespace frontalis
{

/// Closed surface f = 0 of an f that is approximately a signed distance [m], negative inside; its normals point
/// outwards. The surface is found by marching tetrahedra with cells of `edge` [m] in `box`, at whose sides it is
/// closed. `mirrored`: f is symmetric in y, the box is the half with y >= 0, and the other half is added as its mirror
/// image. `error`: by which |f| may exceed the distance from the surface [m].
TriangleMesh isosurface(const std::function<double(const Vector3d&)>& f, const Box& box, double edge, bool mirrored,
                        double error = 0);

}  // namespace frontalis
