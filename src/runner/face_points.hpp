#pragma once

#include "frontalis/model/model.hpp"

#include <array>
#include <vector>

namespace frontalis
{

using Points = std::vector<std::array<float, 3>>;

/// Maps points, or directions where there is no translation, in place.
void transform(const RigidTransform& map, bool with_translation, Points& points);

/// Whether every coordinate is finite.
bool finite(const Points& points);

}  // namespace frontalis
