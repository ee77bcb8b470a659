#pragma once

#include "frontalis/physics/element/voxel_readings.hpp"
#include "frontalis/solver/solver.hpp"

namespace frontalis
{

/// Energies of a plane of voxels or of any other part of a model, and its worst voxel: the one with the smallest J.
struct PlaneMonitor
{
  double kinetic = 0, internal = 0, hourglass = 0;  ///< [J]
  double worst_jacobian = 1e300;
  std::int64_t inverted = 0;
  std::int32_t worst_voxel = -1;

  static FRONTALIS_LAW PlaneMonitor of_voxel(const physics::VoxelReadings<double>& readings, std::int32_t voxel)
  {
    return { 0, readings.internal, readings.hourglass, readings.jacobian, readings.jacobian <= 0 ? 1 : 0, voxel };
  }

  /// Includes another part of the model. Parts must be added in the order of their voxels. A J that is not finite
  /// counts as the smallest.
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
  }
};

/// The monitor of the whole model, from the sum of its parts and the squared frequency bound [1/s2].
Monitor monitor_of(const PlaneMonitor& sum, double frequency_squared, std::int32_t stiffest_voxel);

}  // namespace frontalis
