#pragma once

#include "bake/fibres/muscle_grid.hpp"

#include <vector>

namespace frontalis
{

/// Direction of the fibres that a muscle's surface shows around a cell, along striations or along a narrow muscle. Its
/// sign means nothing.
struct SurfaceDirection
{
  Vector3d direction;
  double certainty = 0;  ///< 0 to 1
};

/// From the covariance of the surface's normals within about `reach` [m] of each cell.
std::vector<SurfaceDirection> surface_directions(const MuscleGrid& grid, double reach);

/// Conductivity of each cell: 1 across its direction, and the less along it the more certain the direction is.
std::vector<Eigen::Matrix3d> conductivities(const std::vector<SurfaceDirection>& directions);

/// The surface's direction where it is certain, the gradient elsewhere; the gradient too where both are at a large
/// angle, as they are at ends that are cut straight. Smoothed over `reach` [m].
std::vector<SurfaceDirection> blend(const MuscleGrid& grid, double reach,
                                    const std::vector<SurfaceDirection>& directions,
                                    const std::vector<Vector3d>& gradients);

}  // namespace frontalis
