#pragma once

#include "bake/shapes/forehead_bone.hpp"

#include <string>

namespace frontalis
{

/// Closed outward mesh of a muscle of the generated forehead, or of its galea.
TriangleMesh make_forehead_muscle(const ForeheadMap& map, const std::string& part, double edge);

}  // namespace frontalis
