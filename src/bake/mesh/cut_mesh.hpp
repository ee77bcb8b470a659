#pragma once

#include "frontalis/scene/scene.hpp"
#include "bake/mesh/surface_mesh.hpp"

namespace frontalis
{

/// The part of a mesh inside a region. Triangles that reach across a side of it are cut there, and neighbours share the
/// new vertices, which follow the kept ones.
TriangleMesh cut_mesh(const TriangleMesh& mesh, const Region& region);

}  // namespace frontalis
