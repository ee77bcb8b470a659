#pragma once

#include "bake/fibres/muscle_grid.hpp"

namespace frontalis
{

/// Hole through the middle of a ring, along the axis in which the muscle is flattest.
struct RingHole
{
  Vector3d centre;
  Vector3d axis;  ///< length 1
};

/// The largest hole, if it has at least a twentieth of the area within the muscle's outline.
std::optional<RingHole> find_hole(const MuscleGrid& grid);

/// Two coordinates of the points of a muscle, both from 0 to 1: u along its fibres, from an arbitrary start if the
/// muscle is a ring, and v across them, along its width.
struct FibreCoordinates
{
  std::vector<std::array<double, 2>> cells;    ///< at the centres of the grid's cells
  std::vector<std::array<double, 2>> samples;  ///< at the samples of its surface; NaN for those in no cell
  double length = 0;                           ///< mean distance from u = 0 to u = 1 [m]
  double width = 0;                            ///< mean distance from v = 0 to v = 1 [m]
  /// Ratio of the length along u to that along the next best direction; infinite if ends or a ring determine u
  double distinctness = 0;
};

/// What determines the direction of fibres. If nothing is given, the muscle's shape does.
struct FibreGuide
{
  std::optional<RingHole> ring;
  /// Distances of a point from the origin and the insertion [m]; both or none
  std::function<double(const Vector3d&)> origin, insertion;
};

/// Both coordinates are scalar fields by trilinear elements on the grid's cells. u is the slowest mode of a conduction
/// problem in the muscle, or the harmonic field between its ends or around its hole; the muscle conducts less along
/// striations and narrow places than across them. v is the slowest mode among the fields that are constant along u.
/// Throws Error if origin and insertion are at the same place.
FibreCoordinates fibre_coordinates(const MuscleGrid& grid, const FibreGuide& guide);

}  // namespace frontalis
