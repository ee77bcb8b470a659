#pragma once

#include "frontalis/bake/bake.hpp"
#include "bake/bake_stages.hpp"
#include "bake/voxels/volumes.hpp"

#include <vector>

namespace frontalis
{

/// Volumes of the muscles that are made of surfaces, in the order of the model's muscles.
std::vector<BakeReport::MuscleVolume> measure_muscles(const Volumes& volumes, const Model& model, BakeStages& stages);

}  // namespace frontalis
