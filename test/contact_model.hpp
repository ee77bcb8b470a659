#pragma once

#include "block_model.hpp"

#include "frontalis/model/sample_field.hpp"

namespace frontalis
{
namespace test
{

/// A body with a plane surface through (0, 0, z): a sphere so large that its curvature is negligible. `side`: -1 if the
/// body is below its surface, +1 if it is above.
inline SampledField plate(double z, int side)
{
  const double radius = 1000;
  return sphere_field({ { 0, 0, z + side * radius } }, radius);
}

/// The lower or upper side of a block as points that touch a body. Each square has a vertex at its centre, so that a
/// uniform pressure gives each node of the square a quarter of the square's force.
inline Contact touching_side(const Model& model, bool upper, const SampledField& field)
{
  Contact contact;
  contact.name = upper ? "upper" : "lower";
  contact.field = field;
  const int nx = model.size[0], ny = model.size[1], nz = model.size[2], k = upper ? nz - 1 : 0;
  TriangleMesh mesh;
  Binding binding;
  const auto add = [&](double x, double y)
  {
    const int i = std::min(static_cast<int>(x), nx - 1), j = std::min(static_cast<int>(y), ny - 1);
    mesh.vertices.push_back({ { x * model.spacing[0], y * model.spacing[1], (upper ? nz : 0) * model.spacing[2] } });
    binding.voxel.push_back((k * ny + j) * nx + i);
    binding.coordinates.push_back({ { static_cast<float>(x - i), static_cast<float>(y - j), upper ? 1.0F : 0.0F } });
  };
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i)
      add(i, j);
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i)
    {
      const int a = j * (nx + 1) + i, b = a + 1, c = a + nx + 1, d = c + 1;
      const auto middle = static_cast<std::int32_t>(mesh.vertices.size());
      add(i + 0.5, j + 0.5);
      for (const auto& edge :
           { std::make_pair(a, b), std::make_pair(b, d), std::make_pair(d, c), std::make_pair(c, a) })
        mesh.triangles.push_back({ { edge.first, edge.second, middle } });
    }
  set_points(contact, mesh, binding);
  return contact;
}

}  // namespace test
}  // namespace frontalis
