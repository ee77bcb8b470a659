#pragma once

#include "frontalis/scene/scene.hpp"
#include "bake/mesh/surface_mesh.hpp"

namespace frontalis
{

/// The part of a mesh inside a region: triangles that reach across its sides are cut there, neighbours sharing the new
/// vertices. Vertices that stay keep their order, new ones follow.
TriangleMesh cut_mesh(const TriangleMesh& mesh, const Region& region);

}  // namespace frontalis
