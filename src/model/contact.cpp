#include "frontalis/model/contact.hpp"

#include "frontalis/physics/number.hpp"

namespace frontalis
{

std::vector<double> vertex_areas(const TriangleMesh& surface)
{
  std::vector<double> area(surface.vertices.size(), 0);
  const auto corner = [&](std::int32_t v)
  {
    const auto& p = surface.vertices[v];
    return physics::Vec3<double>{ p[0], p[1], p[2] };
  };
  for (const auto& t : surface.triangles)
  {
    const auto a = corner(t[0]);
    const double third = norm(cross(corner(t[1]) - a, corner(t[2]) - a)) / 6;
    for (const auto v : t)
      area[v] += third;
  }
  return area;
}

void set_points(Contact& contact, const TriangleMesh& surface, const Binding& binding)
{
  contact.points = surface.vertices;
  contact.binding = binding;
  contact.area = vertex_areas(surface);
}

}  // namespace frontalis
