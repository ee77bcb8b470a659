#pragma once

#include "bake/fibres/muscle_grid.hpp"

#include <Eigen/Core>

#include <vector>

namespace frontalis
{

/// What the surface shows around a cell: a direction along striations or along a narrow muscle, without a sign, and how
/// sure it is, 0 to 1.
struct ShownDirection
{
  Eigen::Vector3d direction;
  double sure = 0;
};

/// From the covariance of the surface's normals within about `reach` [m] of each cell.
std::vector<ShownDirection> shown_directions(const MuscleGrid& grid, double reach);

/// Conductivities of cells: 1 across the directions, as little along them as they are sure.
std::vector<Eigen::Matrix3d> slow_along(const std::vector<ShownDirection>& shown);

/// The direction that the surface shows where it is sure, else that of the gradient; where both are at a large angle,
/// as they are at ends cut straight, that of the gradient too. Smoothed over `reach`.
std::vector<ShownDirection> blend(const MuscleGrid& grid, double reach, const std::vector<ShownDirection>& shown,
                                  const std::vector<Eigen::Vector3d>& gradients);

}  // namespace frontalis
