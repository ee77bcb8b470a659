#pragma once

#include "frontalis/study/voxel_model.hpp"

namespace frontalis
{

/// Lets surfaces of a model, bound to the nearest voxels, touch each other. `friction`: Coulomb's coefficient.
void let_touch(Model& model, const std::vector<TriangleMesh>& surfaces, double friction);

}  // namespace frontalis
