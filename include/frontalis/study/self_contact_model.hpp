#pragma once

#include "frontalis/study/voxel_model.hpp"

namespace frontalis
{

/// Lets surfaces of a model touch each other; each is bound to the nearest voxels. `friction`: Coulomb's coefficient.
void let_touch(Model& model, const std::vector<TriangleMesh>& surfaces, double friction);

}  // namespace frontalis
