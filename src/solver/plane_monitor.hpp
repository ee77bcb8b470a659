#pragma once

#include "frontalis/physics/number.hpp"
#include "frontalis/solver/solver.hpp"

namespace frontalis
{

/// What a look at the voxels of a plane, or of any part of a model, finds.
struct PlaneMonitor
{
  double kinetic = 0, internal = 0, hourglass = 0;  ///< [J]
  double worst_jacobian = 1e300;
  double frequency_squared = 0;  ///< largest bound [1/s2]
  std::int64_t inverted = 0;
  std::int32_t worst_voxel = -1, stiffest_voxel = -1;

  /// Parts must be added in the order of their voxels. Numbers that are not finite count as the worst.
  FRONTALIS_LAW void add(const PlaneMonitor& part)
  {
    kinetic += part.kinetic;
    internal += part.internal;
    hourglass += part.hourglass;
    inverted += part.inverted;
    if (part.worst_voxel >= 0 && !(part.worst_jacobian >= worst_jacobian) && worst_jacobian == worst_jacobian)
    {
      worst_jacobian = part.worst_jacobian;
      worst_voxel = part.worst_voxel;
    }
    if (!(part.frequency_squared <= frequency_squared) && frequency_squared == frequency_squared)
    {
      frequency_squared = part.frequency_squared;
      stiffest_voxel = part.stiffest_voxel;
    }
  }
};

/// The whole model's, from the parts' sum.
Monitor monitor_of(const PlaneMonitor& sum);

}  // namespace frontalis
