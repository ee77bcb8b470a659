#pragma once

#include "frontalis/physics/distance_field.hpp"

#include <cstdint>

namespace frontalis
{

/// Points that are bound to voxels, and the samples around each of them. Lanes beyond the last point are copies of the
/// first.
template <class Real>
struct PointBlock
{
  static constexpr int width = 16;
  static constexpr float none = -1;  ///< deeper in a body than any sample [m]

  std::int32_t node[4][width];  ///< corners 0, 2, 4 and 6 of the voxel; corners 1, 3, 5 and 7 are the nodes after them
  Real coordinates[3][width];   ///< position in the voxel
  Real rest[3][width];          ///< position at rest [m]
  Real body[width];             ///< index of the body, a whole number
  std::int32_t first_body, last_body;  ///< smallest and largest of `body`
  /// cell of the body's field whose samples are in `samples`; if none are stored there, all of `samples` are `none`
  Real cell[3][width];
  Real samples[27][width];  ///< [m]
};

/// A rigid body at its present pose, which maps the body's frame to the scene's.
template <class Real>
struct PosedBody
{
  Real rotation[9], translation[3], origin[3], inverse_spacing;  ///< `origin`: that of the field
  const physics::DistanceField* field;
};

/// Finds the distances [m] of points of a block from their bodies at the displacements u of nodes. Distances are
/// negative where no samples are stored, and from spheres. Those of lanes whose bit is not set in `wanted` are
/// meaningless.
template <class Real>
using PointKernel = void (*)(PointBlock<Real>& block, const Real* const u[3], const PosedBody<Real>* bodies,
                             std::uint32_t wanted, Real* distance);

}  // namespace frontalis
