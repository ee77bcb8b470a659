#pragma once

#include "frontalis/model/model.hpp"

#include <array>
#include <vector>

namespace frontalis
{

/// Folds the moment-free shape of all shells: moves each vertex by `set` times its displacement in the pose that the
/// displacements of the nodes [m] describe. Without a moment, an edge of a shell is then bent further by about `set`
/// times the angle by which the pose bends it. Several calls add up. The membrane is not changed (ShellMesh), so that a
/// pose that shortens the skin leaves no tension.
void add_creases(Model& model, const std::vector<std::array<double, 3>>& displacements, double set);

/// Moves the published skin and the landmarks by the opposite of the displacements of the nodes [m], so that they are
/// at their former places when the tissue has these displacements.
void place_skin_at(Model& model, const std::vector<std::array<double, 3>>& displacements);

}  // namespace frontalis
