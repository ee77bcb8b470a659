#include "bake/mesh/triangle_tree.hpp"

namespace frontalis
{
namespace
{

/// Whether the line from p along `direction` passes the edge from a to b on its left. The two triangles of an edge,
/// which run along it in opposite ways, always get opposite answers, even where the line meets the edge: the edge is
/// taken from the vertex of the lower number.
bool left_of(const Vector3d& direction, const Vector3d& p, const Vector3d& a, const Vector3d& b, std::int32_t number_a,
             std::int32_t number_b)
{
  const bool ordered = number_a < number_b;
  const Vector3d first = (ordered ? a : b) - p, second = (ordered ? b : a) - p;
  return (direction.dot(first.cross(second)) >= 0) == ordered;
}

}  // namespace

int crossing(const TriangleMesh& mesh, std::int32_t triangle, const Vector3d& p, const Vector3d& q)
{
  const Triangle& t = mesh.triangles[triangle];
  const auto [a, b, c] = corners(mesh, t);
  const Vector3d normal = (b - a).cross(c - a);
  const bool p_above = normal.dot(p - a) > 0, q_above = normal.dot(q - a) > 0;
  if (p_above == q_above)
    return 0;
  const Vector3d direction = q - p;
  const bool ab = left_of(direction, p, a, b, t[0], t[1]);
  const bool bc = left_of(direction, p, b, c, t[1], t[2]);
  const bool ca = left_of(direction, p, c, a, t[2], t[0]);
  if (ab != bc || bc != ca)
    return 0;
  return p_above ? 1 : -1;
}

bool TriangleTree::crossed_by(const Vector3d& p, const Vector3d& q) const
{
  const Box box = Box(p).extend(q);
  return visit([&](std::size_t node) { return nodes_[node].box.intersects(box); },
               [&](std::size_t i) { return crossing(*mesh_, order_[i], p, q) != 0; });
}

}  // namespace frontalis
