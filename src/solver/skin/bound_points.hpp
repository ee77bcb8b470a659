#pragma once

#include "frontalis/model/model.hpp"
#include "frontalis/physics/trilinear.hpp"
#include "frontalis/solver/solver.hpp"

#include <array>

namespace frontalis
{

/// Displacement [m] of a point tied to a voxel.
template <class Real>
std::array<double, 3> bound_displacement(const Model& model, const Binding& binding, std::size_t point,
                                         const Real* const u[3])
{
  const auto& c = binding.coordinates[point];
  double weight[8];
  physics::trilinear_weights<double>(c[0], c[1], c[2], weight);
  const auto& nodes = model.voxel_nodes[binding.voxel[point]];
  std::array<double, 3> sum{ { 0, 0, 0 } };
  for (int b = 0; b < 8; ++b)
    for (int axis = 0; axis < 3; ++axis)
      sum[axis] += weight[b] * u[axis][nodes[b]];
  return sum;
}

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

/// Skin vertices, their normals and the landmarks at the present displacements.
template <class Real>
void skin_state(const Model& model, const Real* const u[3], SkinState& out)
{
  const auto place = [&](const std::vector<std::array<double, 3>>& rest, const Binding& binding, auto& positions)
  {
    positions.resize(rest.size());
    for (std::size_t p = 0; p < rest.size(); ++p)
    {
      const auto moved = bound_displacement(model, binding, p, u);
      for (int axis = 0; axis < 3; ++axis)
        positions[p][axis] = static_cast<float>(rest[p][axis] + moved[axis]);
    }
  };
  place(model.skin.vertices, model.skin_binding, out.vertices);
  place(model.landmark_positions, model.landmark_binding, out.landmarks);
  surface_normals(model.skin.triangles, out.vertices, out.normals);
}

}  // namespace frontalis
