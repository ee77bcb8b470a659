#pragma once

#include "bake/fibres/fibre_coordinates.hpp"
#include "bake/fibres/nurbs_volume.hpp"
#include "bake/mesh/triangle_tree.hpp"

namespace frontalis
{

/// Fits a NURBS volume to a muscle. The volume's outer surface (w = 1) is cubic, closed around the fibres and, in a
/// ring, also along them. It is fitted to the muscle's mesh by least squares, in which samples outside the surface have
/// more weight. The inner surface (w = 0) is a sheet midway between the two sides of the muscle.
NurbsVolume fit_nurbs(const MuscleGrid& grid, const FibreCoordinates& coordinates, bool ring);

struct NurbsFit
{
  double volume = 0;    ///< volume enclosed by the outer surface [m3]
  double enclosed = 0;  ///< proportion of the muscle's cells whose centres are inside the outer surface
  double distance = 0;  ///< RMS distance of the muscle's mesh from the outer surface [m]
};
/// Measures how well the volume's outer surface fits the muscle.
NurbsFit measure_fit(const NurbsVolume& volume, const MuscleGrid& grid, const TriangleTree& muscle);

}  // namespace frontalis
