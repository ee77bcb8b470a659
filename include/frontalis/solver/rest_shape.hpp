#pragma once

#include "frontalis/model/model.hpp"

#include <array>
#include <vector>

namespace frontalis
{

/// Folds the stress-free shape of all shells: moves their vertices by `set` times the displacements that they have at
/// the given ones of the nodes [m]. An edge of a shell then has, free of moment, about `set` times the angle that it
/// has in that pose, in addition to the angle that it had before. Calls add up. The membrane is not changed
/// (ShellMesh), so that a pose that shortens the skin leaves no tension.
void add_creases(Model& model, const std::vector<std::array<double, 3>>& displacements, double set);

/// Moves the published skin and the landmarks against the displacements of the nodes [m], so that they are at their
/// places when the tissue is displaced like this.
void place_skin_at(Model& model, const std::vector<std::array<double, 3>>& displacements);

}  // namespace frontalis
