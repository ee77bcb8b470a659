#include "study/models/shape_model.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace frontalis
{

std::function<double(const std::array<std::int32_t, 3>&)> sampled_fill(
    const std::array<double, 3>& spacing, const std::function<bool(const std::array<double, 3>&)>& inside, int samples,
    double fill_min)
{
  return [=](const std::array<std::int32_t, 3>& voxel)
  {
    int count = 0;
    for (int k = 0; k < samples; ++k)
      for (int j = 0; j < samples; ++j)
        for (int i = 0; i < samples; ++i)
          count +=
              inside({ { (voxel[0] + (i + 0.5) / samples) * spacing[0], (voxel[1] + (j + 0.5) / samples) * spacing[1],
                         (voxel[2] + (k + 0.5) / samples) * spacing[2] } });
    const double fill = count / std::pow(samples, 3);
    return fill < fill_min ? 0 : fill;
  };
}

Binding bind_points(const Model& model, const std::vector<std::array<double, 3>>& points)
{
  std::map<std::array<std::int32_t, 3>, std::int32_t> index;
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
    index[model.voxels[e]] = static_cast<std::int32_t>(e);
  Binding binding;
  for (const auto& point : points)
  {
    std::array<std::int32_t, 3> at;
    for (std::size_t axis = 0; axis < 3; ++axis)
      at[axis] = static_cast<std::int32_t>(std::floor(point[axis] / model.spacing[axis]));
    // the nearest of the voxels around the point
    double nearest = 1e300;
    std::int32_t best = 0;
    for (int k = -2; k <= 2; ++k)
      for (int j = -2; j <= 2; ++j)
        for (int i = -2; i <= 2; ++i)
        {
          const auto found = index.find({ { at[0] + i, at[1] + j, at[2] + k } });
          if (found == index.end())
            continue;
          double squared = 0;
          for (std::size_t axis = 0; axis < 3; ++axis)
          {
            const double low = found->first[axis] * model.spacing[axis];
            const double outside = std::max({ low - point[axis], point[axis] - low - model.spacing[axis], 0.0 });
            squared += outside * outside;
          }
          if (squared < nearest)
          {
            nearest = squared;
            best = found->second;
          }
        }
    binding.voxel.push_back(best);
    std::array<float, 3> coordinates;
    for (std::size_t axis = 0; axis < 3; ++axis)
      coordinates[axis] = static_cast<float>(point[axis] / model.spacing[axis] - model.voxels[best][axis]);
    binding.coordinates.push_back(coordinates);
  }
  return binding;
}

TriangleMesh grid_mesh(int rows, int columns, const std::function<std::array<double, 3>(double, double)>& point)
{
  TriangleMesh mesh;
  for (int i = 0; i <= rows; ++i)
    for (int j = 0; j <= columns; ++j)
      mesh.vertices.push_back(point(static_cast<double>(i) / rows, static_cast<double>(j) / columns));
  const auto add = [&mesh](int a, int b, int c)
  {
    const auto apart = [&](int m, int n)
    {
      const auto &p = mesh.vertices[m], &q = mesh.vertices[n];
      return std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]) > 1e-12;
    };
    if (apart(a, b) && apart(b, c) && apart(c, a))
      mesh.triangles.push_back({ { a, b, c } });
  };
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j)
    {
      const int corner = i * (columns + 1) + j, below = corner + columns + 1;
      add(corner, below, below + 1);
      add(corner, below + 1, corner + 1);
    }
  return mesh;
}

}  // namespace frontalis
