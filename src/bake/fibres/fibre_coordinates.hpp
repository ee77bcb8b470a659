#pragma once

#include "bake/fibres/muscle_grid.hpp"

#include <functional>
#include <optional>
#include <vector>

namespace frontalis
{

/// Hole through the middle of a ring, seen along the axis in which the muscle is flattest.
struct RingHole
{
  Vector3 centre;
  Vector3 axis;  ///< length 1
};

/// The largest hole, where it has at least a twentieth of the area within the muscle's outline.
std::optional<RingHole> find_hole(const MuscleGrid& grid);

/// Two coordinates of points of a muscle: u along its fibres, 0 to 1 (around a ring, from anywhere), and v across them
/// where it is widest, 0 to 1.
struct FibreCoordinates
{
  std::vector<std::array<double, 2>> cells;    ///< at the centres of the grid's cells
  std::vector<std::array<double, 2>> samples;  ///< at the samples of its surface; NaN where they have no cell
  double length = 0;                           ///< mean way from u = 0 to 1 [m]
  double width = 0;                            ///< mean way from v = 0 to 1 [m]
  /// How much slower the field varies along u than along the next best way, as a ratio of lengths; infinite where ends
  /// or a ring decide
  double distinctness = 0;
};

/// What decides where fibres run, found from the shape where nothing is given.
struct FibreGuide
{
  std::optional<RingHole> ring;
  /// Distances of a point from origin and insertion [m]; both or none
  std::function<double(const Vector3&)> origin, insertion;
};

/// u is the slowest mode of the muscle (or harmonic between its ends, or around its hole), where varying across
/// striations and across narrow places costs more than along them; v is the slowest mode of what is constant along u.
/// Both by trilinear elements on the grid's cells. Throws Error where origin and insertion are at the same place.
FibreCoordinates fibre_coordinates(const MuscleGrid& grid, const FibreGuide& guide);

}  // namespace frontalis
