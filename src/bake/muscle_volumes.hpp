#pragma once

#include "frontalis/bake/bake.hpp"
#include "stages.hpp"
#include "volumes.hpp"

#include <vector>

namespace frontalis
{

/// Volumes of the muscles that are made of surfaces, in the order of the model's muscles.
std::vector<BakeReport::MuscleVolume> measure_muscles(const Volumes& volumes, const Model& model, Stages& stages);

}  // namespace frontalis
