#pragma once

#include "frontalis/bake/bake.hpp"
#include "bake/bake_monitor.hpp"
#include "bake/voxels/volumes.hpp"

#include <vector>

namespace frontalis
{

/// Volumes of those muscles that are made of surfaces, in the order of the model's muscles.
std::vector<BakeReport::MuscleVolume> measure_muscles(const Volumes& volumes, const Model& model, BakeMonitor& monitor);

}  // namespace frontalis
