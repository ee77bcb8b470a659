#pragma once

#include "block_model.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace frontalis
{
namespace test
{

struct ShellSettings
{
  double height = 4e-3;  ///< height of the shell in the block [m]
  double edge = 1.2e-3;  ///< approximate edge of its triangles along x and y [m]
  double thickness = 0.1e-3;
  double young = 1e6;
  double poisson = 0.4;
};

/// Adds a flat shell across a whole block, of irregular triangles.
inline void add_shell(Model& model, const ShellSettings& s = {})
{
  Material material = model.materials[0];
  material.name = "film";
  material.parameters[0] = s.young / (2 * (1 + s.poisson));
  material.parameters[1] = s.young / (3 * (1 - 2 * s.poisson));
  model.materials.push_back(material);
  Shell shell;
  shell.name = "film";
  shell.thickness = s.thickness;
  shell.material = static_cast<std::int32_t>(model.materials.size()) - 1;
  const double length[2] = { model.size[0] * model.spacing[0], model.size[1] * model.spacing[1] };
  const int n = static_cast<int>(std::lround(length[0] / s.edge)),
            m = static_cast<int>(std::lround(length[1] / s.edge));
  for (int j = 0; j <= m; ++j)
    for (int i = 0; i <= n; ++i)
    {
      const double shift = i == 0 || i == n || j == 0 || j == m ? 0 : 0.2;
      const double x = length[0] * (i + shift * std::sin(3.0 * i + 5 * j)) / n;
      const double y = length[1] * (j + shift * std::cos(4.0 * i + 3 * j)) / m;
      const double p[3] = { x, y, s.height };
      std::array<std::int32_t, 3> place{};
      std::array<float, 3> within{};
      for (std::size_t axis = 0; axis < 3; ++axis)
      {
        place[axis] = std::min(static_cast<std::int32_t>(p[axis] / model.spacing[axis]), model.size[axis] - 1);
        within[axis] = static_cast<float>(p[axis] / model.spacing[axis] - place[axis]);
      }
      shell.surface.vertices.push_back({ { x, y, s.height } });
      shell.binding.voxel.push_back((place[2] * model.size[1] + place[1]) * model.size[0] + place[0]);
      shell.binding.coordinates.push_back(within);
    }
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < n; ++i)
    {
      const int a = j * (n + 1) + i, b = a + 1, c = a + n + 1, d = c + 1;
      const bool slash = (i + j) % 2 == 0;
      shell.surface.triangles.push_back(slash ? std::array<std::int32_t, 3>{ { a, b, d } }
                                              : std::array<std::int32_t, 3>{ { a, b, c } });
      shell.surface.triangles.push_back(slash ? std::array<std::int32_t, 3>{ { a, d, c } }
                                              : std::array<std::int32_t, 3>{ { b, d, c } });
    }
  model.shells.push_back(shell);
}

}  // namespace test
}  // namespace frontalis
