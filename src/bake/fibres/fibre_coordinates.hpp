#pragma once

#include "bake/fibres/muscle_grid.hpp"

namespace frontalis
{

/// Hole through a ring-shaped muscle. Its axis is the direction in which the muscle is thinnest.
struct RingHole
{
  Vector3d centre;
  Vector3d axis;  ///< unit vector
};

/// Returns the largest hole; none if its area is less than a twentieth of the area within the muscle's outline.
std::optional<RingHole> find_hole(const MuscleGrid& grid);

/// Two coordinates of points of a muscle, both from 0 to 1: u along the fibres and v across them, along the muscle's
/// width. In a ring u starts at an arbitrary angle.
struct FibreCoordinates
{
  std::vector<std::array<double, 2>> cells;    ///< (u, v) at the centres of the grid's cells
  std::vector<std::array<double, 2>> samples;  ///< (u, v) at the samples of the muscle's surface; NaN outside all cells
  double length = 0;                           ///< mean distance from u = 0 to u = 1 [m]
  double width = 0;                            ///< mean distance from v = 0 to v = 1 [m]
  /// Ratio of the muscle's length along u to that along the second slowest mode of heat conduction. Infinite if u
  /// follows from ends or a ring.
  double distinctness = 0;
};

/// Ring or ends from which the fibre direction follows. Without them it follows from the muscle's shape.
struct FibreGuide
{
  std::optional<RingHole> ring;
  /// Distances of a point from the origin and from the insertion [m]; either both are set or neither.
  std::function<double(const Vector3d&)> origin, insertion;
};

/// Finds both coordinates as scalar fields of trilinear elements on the grid's cells. If `guide` has ends or a hole, u
/// is the harmonic field between the ends or around the hole. Otherwise u is the slowest mode of heat conduction in the
/// muscle, whose conductivity is lower along striations and narrow regions than across them. v is the slowest mode that
/// is constant along the fibres. Throws Error if origin and insertion are at the same place.
FibreCoordinates fibre_coordinates(const MuscleGrid& grid, const FibreGuide& guide);

}  // namespace frontalis
