#pragma once

#include "frontalis/physics/trilinear.hpp"

namespace frontalis
{

/// Adds the displacements of points that are bound to voxels, one per lane, to `from`. `block` has the corners 0, 2, 4
/// and 6 of each voxel as `node`, after which the nodes of corners 1, 3, 5 and 7 follow, and the `coordinates` in the
/// voxel.
template <class Lanes, class Block>
FRONTALIS_LAW physics::Vec3<typename Lanes::Batch> displaced(physics::Vec3<typename Lanes::Batch> from,
                                                             const Block& block, const typename Lanes::Real* const u[3],
                                                             int lane)
{
  typename Lanes::Batch weight[8];
  physics::trilinear_weights(Lanes::load(block.coordinates[0] + lane), Lanes::load(block.coordinates[1] + lane),
                             Lanes::load(block.coordinates[2] + lane), weight);
  for (int two = 0; two < 4; ++two)
  {
    physics::Vec3<typename Lanes::Batch> low, high;
    Lanes::gather_two(u[0], block.node[two] + lane, low.x, high.x);
    Lanes::gather_two(u[1], block.node[two] + lane, low.y, high.y);
    Lanes::gather_two(u[2], block.node[two] + lane, low.z, high.z);
    from = from + weight[2 * two] * low + weight[2 * two + 1] * high;
  }
  return from;
}

}  // namespace frontalis
