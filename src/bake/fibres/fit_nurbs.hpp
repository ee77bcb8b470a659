#pragma once

#include "bake/fibres/fibre_coordinates.hpp"
#include "bake/fibres/nurbs_volume.hpp"
#include "bake/mesh/triangle_tree.hpp"

namespace frontalis
{

/// NURBS volume of a muscle: a cubic surface around its mesh, closed across and, in a ring, along, fitted by least
/// squares in which what sticks out counts most; the volume is spanned between the surface (w = 1) and what remains of
/// it when it is shrunk inwards to the sheet midway between its two sides (w = 0).
NurbsVolume fit_nurbs(const MuscleGrid& grid, const FibreCoordinates& coordinates, bool ring);

/// Triangles of the volume's surface w = 1, closed by caps unless it is a ring.
TriangleMesh outer_surface(const NurbsVolume& volume);

/// How well the outer surface fits a muscle.
struct NurbsFit
{
  double volume = 0;    ///< within the outer surface [m3]
  double enclosed = 0;  ///< proportion of the muscle, by the centres of the grid's cells
  double distance = 0;  ///< root mean square distance of the mesh from it [m]
};
NurbsFit measure_fit(const NurbsVolume& volume, const MuscleGrid& grid, const TriangleTree& muscle);

}  // namespace frontalis
