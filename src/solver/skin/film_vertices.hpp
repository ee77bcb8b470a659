#pragma once

#include "frontalis/model/model.hpp"
#include "frontalis/solver/solver.hpp"

namespace frontalis
{

/// Finds the normals of the skin, and places the vertices in the middles of edges (SkinFilm::parents) from those that
/// follow the voxels.
void place_film_vertices(const Model& model, SkinState& skin);

}  // namespace frontalis
