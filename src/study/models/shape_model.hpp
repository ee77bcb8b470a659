#pragma once

#include "frontalis/study/voxel_model.hpp"

namespace frontalis
{

/// Proportion of voxel (i,j,k) that is inside a shape, from samples^3 points; 0 below `fill_min`. The defaults are
/// those of a bake.
std::function<double(const std::array<std::int32_t, 3>&)> sampled_fill(
    const std::array<double, 3>& spacing, const std::function<bool(const std::array<double, 3>&)>& inside,
    int samples = 4, double fill_min = 0.2);

/// Binds points at rest [m] to the voxel that they are in, or to the nearest one.
Binding bind_points(const Model& model, const std::vector<std::array<double, 3>>& points);

/// The triangles of a grid of points, point(s, t) with s and t from 0 to 1 in so many rows and columns; triangles
/// without area are left out.
TriangleMesh grid_mesh(int rows, int columns, const std::function<std::array<double, 3>(double, double)>& point);

}  // namespace frontalis
