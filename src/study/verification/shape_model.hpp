#pragma once

#include "frontalis/study/voxel_model.hpp"

namespace frontalis
{

/// Proportion of voxel (i,j,k) that is inside a shape, from samples^3 points, 0 below `fill_min`: what a bake does by
/// default.
std::function<double(const std::array<std::int32_t, 3>&)> sampled_fill(
    const std::array<double, 3>& spacing, const std::function<bool(const std::array<double, 3>&)>& inside,
    int samples = 4, double fill_min = 0.2);

/// Ties points at rest [m] to the voxel that they are in, or the nearest.
Binding bind_points(const Model& model, const std::vector<std::array<double, 3>>& points);

/// Quadrilaterals of a grid of points p(i, j), 0 <= i <= rows, 0 <= j <= columns, as triangles; those of no area are
/// left out.
TriangleMesh grid_mesh(int rows, int columns, const std::function<std::array<double, 3>(double, double)>& point);

}  // namespace frontalis
