#pragma once

#include "frontalis/model/surface.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace frontalis
{
namespace test
{

/// A sphere whose triangles are those of an octahedron, each cut into divisions^2, with their corners on the sphere.
inline TriangleMesh sphere(double radius, const std::array<double, 3>& centre, int divisions)
{
  TriangleMesh mesh;
  std::map<std::array<int, 3>, std::int32_t> known;
  const auto vertex = [&](int x, int y, int z)
  {
    const auto entry = known.emplace(std::array<int, 3>{ { x, y, z } }, static_cast<std::int32_t>(known.size()));
    if (entry.second)
    {
      const double scale = radius / std::sqrt(double(x * x + y * y + z * z));
      mesh.vertices.push_back({ { centre[0] + scale * x, centre[1] + scale * y, centre[2] + scale * z } });
    }
    return entry.first->second;
  };
  for (int octant = 0; octant < 8; ++octant)
  {
    const int sx = octant & 1 ? -1 : 1, sy = octant & 2 ? -1 : 1, sz = octant & 4 ? -1 : 1;
    const auto add = [&](std::int32_t a, std::int32_t b, std::int32_t c)
    {
      if (sx * sy * sz > 0)
        mesh.triangles.push_back({ { a, b, c } });
      else
        mesh.triangles.push_back({ { a, c, b } });
    };
    const auto at = [&](int a, int b) { return vertex(sx * (divisions - a - b), sy * a, sz * b); };
    for (int a = 0; a < divisions; ++a)
      for (int b = 0; a + b < divisions; ++b)
      {
        add(at(a, b), at(a + 1, b), at(a, b + 1));
        if (a + b + 1 < divisions)
          add(at(a + 1, b), at(a + 1, b + 1), at(a, b + 1));
      }
  }
  return mesh;
}

}  // namespace test
}  // namespace frontalis
