#pragma once

#include "bake/fibres/fibre_coordinates.hpp"
#include "bake/fibres/nurbs_volume.hpp"
#include "bake/mesh/triangle_tree.hpp"

namespace frontalis
{

/// NURBS volume of a muscle. Its outer surface (w = 1) is cubic, closed around the fibres and, in a ring, also along
/// them. It is fitted to the muscle's mesh by least squares; samples outside it have the larger weight. Its inner
/// surface (w = 0) is a sheet midway between the two sides of the muscle.
NurbsVolume fit_nurbs(const MuscleGrid& grid, const FibreCoordinates& coordinates, bool ring);

/// Closed mesh of the volume's outer surface, with caps at its ends unless it is a ring.
TriangleMesh outer_surface(const NurbsVolume& volume);

struct NurbsFit
{
  double volume = 0;    ///< enclosed by the outer surface [m3]
  double enclosed = 0;  ///< proportion of the muscle's cells whose centres are inside it
  double distance = 0;  ///< RMS distance of the muscle's mesh from it [m]
};
/// Measures how well the volume's outer surface fits the muscle.
NurbsFit measure_fit(const NurbsVolume& volume, const MuscleGrid& grid, const TriangleTree& muscle);

}  // namespace frontalis
