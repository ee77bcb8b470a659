#include "bake/mesh/triangle_tree.hpp"

namespace frontalis
{
namespace
{

/// Sign of the volume of the tetrahedron (p, q, a, b); exactly opposite for (b, a), zero counted as a place on one
/// side, so that a segment that meets a shared edge crosses exactly one of its triangles.
bool left_of(const Vector3& direction, const Vector3& p, const Vector3& a, const Vector3& b, std::int32_t number_a,
             std::int32_t number_b)
{
  const bool ordered = number_a < number_b;
  const Vector3 first = (ordered ? a : b) - p, second = (ordered ? b : a) - p;
  return (dot(direction, cross(first, second)) >= 0) == ordered;
}

}  // namespace

int crossing(const TriangleMesh& mesh, std::int32_t triangle, const Vector3& p, const Vector3& q)
{
  const Triangle& t = mesh.triangles[static_cast<std::size_t>(triangle)];
  const Vector3& a = mesh.vertices[static_cast<std::size_t>(t[0])];
  const Vector3& b = mesh.vertices[static_cast<std::size_t>(t[1])];
  const Vector3& c = mesh.vertices[static_cast<std::size_t>(t[2])];
  const Vector3 normal = cross(b - a, c - a);
  const bool p_above = dot(normal, p - a) > 0, q_above = dot(normal, q - a) > 0;
  if (p_above == q_above)
    return 0;
  const Vector3 direction = q - p;
  const bool ab = left_of(direction, p, a, b, t[0], t[1]);
  const bool bc = left_of(direction, p, b, c, t[1], t[2]);
  const bool ca = left_of(direction, p, c, a, t[2], t[0]);
  if (ab != bc || bc != ca)
    return 0;
  return p_above ? 1 : -1;
}

bool TriangleTree::crossed_by(const Vector3& p, const Vector3& q) const
{
  Box box;
  box.include(p);
  box.include(q);
  return visit([&](std::size_t node) { return nodes_[node].box.overlaps(box); },
               [&](std::size_t i) { return crossing(*mesh_, order_[i], p, q) != 0; });
}

}  // namespace frontalis
