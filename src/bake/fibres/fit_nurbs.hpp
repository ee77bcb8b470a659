#pragma once

#include "bake/fibres/fibre_coordinates.hpp"
#include "bake/fibres/nurbs_volume.hpp"
#include "bake/mesh/triangle_tree.hpp"

namespace frontalis
{

/// NURBS volume of a muscle. Its outer surface (w = 1) is cubic, closed across the fibres and, in a ring, along them,
/// and fitted to the muscle's mesh by least squares in which samples outside it have the larger weight. From there the
/// volume reaches inwards to the sheet midway between the two sides of the muscle (w = 0).
NurbsVolume fit_nurbs(const MuscleGrid& grid, const FibreCoordinates& coordinates, bool ring);

/// Closed mesh of the volume's outer surface, with caps at its ends unless it is a ring.
TriangleMesh outer_surface(const NurbsVolume& volume);

struct NurbsFit
{
  double volume = 0;    ///< within the outer surface [m3]
  double enclosed = 0;  ///< proportion of the muscle within it, by the centres of the grid's cells
  double distance = 0;  ///< root mean square distance of the muscle's mesh from it [m]
};
/// How well the volume's outer surface fits the muscle.
NurbsFit measure_fit(const NurbsVolume& volume, const MuscleGrid& grid, const TriangleTree& muscle);

}  // namespace frontalis
