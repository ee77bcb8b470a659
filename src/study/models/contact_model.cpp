#include "frontalis/study/contact_model.hpp"

#include "frontalis/model/sample_field.hpp"

#include <algorithm>

namespace frontalis
{

SampledField flat_body(double z, int side)
{
  constexpr double radius = 1000;
  return sphere_field({ { 0, 0, z + side * radius } }, radius);
}

Contact touching_side(const Model& model, bool upper, SampledField body)
{
  Contact contact;
  contact.name = upper ? "upper side" : "lower side";
  contact.field = std::move(body);
  const std::int32_t nx = model.size[0], ny = model.size[1], nz = model.size[2], k = upper ? nz - 1 : 0;
  TriangleMesh mesh;
  Binding binding;
  const auto add = [&](double x, double y)
  {
    const auto i = std::min(static_cast<std::int32_t>(x), nx - 1), j = std::min(static_cast<std::int32_t>(y), ny - 1);
    mesh.vertices.push_back({ { x * model.spacing[0], y * model.spacing[1], (upper ? nz : 0) * model.spacing[2] } });
    binding.voxel.push_back((k * ny + j) * nx + i);
    binding.coordinates.push_back({ { static_cast<float>(x - i), static_cast<float>(y - j), upper ? 1.0F : 0.0F } });
  };
  for (std::int32_t j = 0; j <= ny; ++j)
    for (std::int32_t i = 0; i <= nx; ++i)
      add(i, j);
  for (std::int32_t j = 0; j < ny; ++j)
    for (std::int32_t i = 0; i < nx; ++i)
    {
      const std::int32_t a = j * (nx + 1) + i, b = a + 1, c = a + nx + 1, d = c + 1;
      const auto middle = static_cast<std::int32_t>(mesh.vertices.size());
      add(i + 0.5, j + 0.5);
      for (const auto& edge : { std::array<std::int32_t, 2>{ { a, b } }, { { b, d } }, { { d, c } }, { { c, a } } })
        mesh.triangles.push_back({ { edge[0], edge[1], middle } });
    }
  set_points(contact, mesh, binding);
  return contact;
}

}  // namespace frontalis
