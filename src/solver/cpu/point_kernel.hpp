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

/// Points of a block beside their bodies. Lengths are in spacings of the body's field, unless noted otherwise.
template <class Real>
struct PointPlaces
{
  Real distance[PointBlock<Real>::width];     ///< from the body [m]; PointBlock::none from spheres and without samples
  Real gradient[3][PointBlock<Real>::width];  ///< of `distance`, in the body's frame [m]
  Real offset[3][PointBlock<Real>::width];    ///< position relative to the field's origin, in the body's frame
};

/// Finds the places of points of a block at the displacements u of nodes. Those of lanes whose bit is not set in
/// `wanted` are meaningless.
template <class Real>
using PointKernel = void (*)(PointBlock<Real>& block, const Real* const u[3], const PosedBody<Real>* bodies,
                             std::uint32_t wanted, PointPlaces<Real>& places);

}  // namespace frontalis
