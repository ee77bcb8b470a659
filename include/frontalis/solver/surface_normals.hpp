#pragma once

#include "frontalis/physics/number.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace frontalis
{

/// Sets the normals at the vertices to area-weighted means; the cross product of two edges is twice a triangle's area.
inline void surface_normals(const std::vector<std::array<std::int32_t, 3>>& triangles,
                            const std::vector<std::array<float, 3>>& vertices,
                            std::vector<std::array<float, 3>>& normals)
{
  normals.assign(vertices.size(), { { 0, 0, 0 } });
  const auto vector = [](const std::array<float, 3>& a) { return physics::Vec3<float>{ a[0], a[1], a[2] }; };
  for (const auto& t : triangles)
  {
    const auto a = vector(vertices[t[0]]);
    const auto area = cross(vector(vertices[t[1]]) - a, vector(vertices[t[2]]) - a);
    for (const auto corner : t)
    {
      normals[corner][0] += area.x;
      normals[corner][1] += area.y;
      normals[corner][2] += area.z;
    }
  }
  for (auto& normal : normals)
  {
    const float length = std::sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
    for (auto& x : normal)
      x = length > 0 ? x / length : 0;
  }
}

}  // namespace frontalis
