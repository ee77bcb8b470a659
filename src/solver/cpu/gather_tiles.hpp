#pragma once

#include "solver/cpu/voxel_rows.hpp"

namespace frontalis
{

/// Puts the voxels [first, last) of a plane into tiles; only their nodes and voxels are set. Strips with the same
/// muscles and laws share a tile, because a tile computes each of them for all of its voxels. Where there is a choice,
/// the two strips are far apart: strips that add forces to the same nodes would wait for each other. `properties`: one
/// entry per voxel.
std::vector<Tile> gather_tiles(const Model& model, std::int32_t first, std::int32_t last,
                               const VoxelProperties* properties);

}  // namespace frontalis
