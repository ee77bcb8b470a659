#include "surface_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

namespace frontalis
{
namespace
{

using Point = SurfaceTree::Point;

Point point(const std::array<double, 3>& a) { return { a[0], a[1], a[2] }; }
double coordinate(const Point& p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

Point unit(const Point& a)
{
  const double length = physics::norm(a);
  return length > 0 ? (1 / length) * a : Point{ 0, 0, 0 };
}

double angle(const Point& a, const Point& b)
{
  return std::atan2(physics::norm(physics::cross(a, b)), physics::dot(a, b));
}

double squared_distance(const float* lower, const float* upper, const Point& p)
{
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double x = coordinate(p, axis);
    const double d = std::max({ lower[axis] - x, x - upper[axis], 0.0 });
    sum += d * d;
  }
  return sum;
}

}  // namespace

SurfaceTree::SurfaceTree(const TriangleMesh& mesh) : corners_(mesh.triangles)
{
  const std::size_t count = mesh.triangles.size();
  vertex_normals_.assign(mesh.vertices.size(), Point{ 0, 0, 0 });
  face_normals_.resize(count);
  edge_normals_.resize(count);
  std::map<std::pair<std::int32_t, std::int32_t>, Point> edges;
  const auto edge_of = [](std::int32_t a, std::int32_t b) { return std::make_pair(std::min(a, b), std::max(a, b)); };
  for (std::size_t t = 0; t < count; ++t)
  {
    const auto& corner = mesh.triangles[t];
    Triangle triangle{};
    for (int c = 0; c < 3; ++c)
      triangle.corner[c] = point(mesh.vertices[corner[c]]);
    triangle.index = static_cast<std::int32_t>(t);
    triangles_.push_back(triangle);
    face_normals_[t] = unit(cross(triangle.corner[1] - triangle.corner[0], triangle.corner[2] - triangle.corner[0]));
    for (int c = 0; c < 3; ++c)
    {
      const Point& here = triangle.corner[c];
      const double weight = angle(triangle.corner[(c + 1) % 3] - here, triangle.corner[(c + 2) % 3] - here);
      vertex_normals_[corner[c]] = vertex_normals_[corner[c]] + weight * face_normals_[t];
      Point& edge = edges[edge_of(corner[c], corner[(c + 1) % 3])];
      edge = edge + face_normals_[t];
    }
  }
  for (auto& normal : vertex_normals_)
    normal = unit(normal);
  for (std::size_t t = 0; t < count; ++t)
    for (int c = 0; c < 3; ++c)
      edge_normals_[t][c] = unit(edges[edge_of(corners_[t][c], corners_[t][(c + 1) % 3])]);
  if (count > 0)
    build(0, static_cast<std::int32_t>(count));
}

void SurfaceTree::build(std::int32_t first, std::int32_t last)
{
  Box box{};
  std::fill(box.lower, box.lower + 3, std::numeric_limits<float>::max());
  std::fill(box.upper, box.upper + 3, std::numeric_limits<float>::lowest());
  Point low{ 1e300, 1e300, 1e300 }, high{ -1e300, -1e300, -1e300 };
  const auto centre = [](const Triangle& t) { return (1.0 / 3) * (t.corner[0] + t.corner[1] + t.corner[2]); };
  for (auto t = first; t < last; ++t)
  {
    for (const auto& corner : triangles_[t].corner)
      for (int axis = 0; axis < 3; ++axis)
      {
        const auto x = static_cast<float>(coordinate(corner, axis));
        box.lower[axis] = std::min(box.lower[axis], std::nextafter(x, std::numeric_limits<float>::lowest()));
        box.upper[axis] = std::max(box.upper[axis], std::nextafter(x, std::numeric_limits<float>::max()));
      }
    const Point c = centre(triangles_[t]);
    low = { std::min(low.x, c.x), std::min(low.y, c.y), std::min(low.z, c.z) };
    high = { std::max(high.x, c.x), std::max(high.y, c.y), std::max(high.z, c.z) };
  }
  const std::size_t self = boxes_.size();
  constexpr std::int32_t leaf_size = 4;
  box.first = first;
  box.count = last - first <= leaf_size ? last - first : 0;
  boxes_.push_back(box);
  if (box.count > 0)
    return;
  const Point extent = high - low;
  const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  const auto middle = first + (last - first) / 2;
  std::nth_element(triangles_.begin() + first, triangles_.begin() + middle, triangles_.begin() + last,
                   [&](const Triangle& a, const Triangle& b)
                   {
                     const double ca = coordinate(centre(a), axis), cb = coordinate(centre(b), axis);
                     return ca != cb ? ca < cb : a.index < b.index;
                   });
  build(first, middle);
  boxes_[self].first = static_cast<std::int32_t>(boxes_.size());
  build(middle, last);
}

Point SurfaceTree::pseudonormal(const Triangle& triangle, const Point& at) const
{
  // barycentric coordinates say whether the point lies on the face, an edge or a corner
  const Point& a = triangle.corner[0];
  const Point ab = triangle.corner[1] - a, ac = triangle.corner[2] - a, ap = at - a;
  const double d00 = dot(ab, ab), d01 = dot(ab, ac), d11 = dot(ac, ac), d20 = dot(ap, ab), d21 = dot(ap, ac);
  const double determinant = d00 * d11 - d01 * d01;
  if (!(determinant > 0))
    return vertex_normals_[corners_[triangle.index][0]];
  double weight[3];
  weight[1] = (d11 * d20 - d01 * d21) / determinant;
  weight[2] = (d00 * d21 - d01 * d20) / determinant;
  weight[0] = 1 - weight[1] - weight[2];
  constexpr double on_boundary = 1e-7;
  for (int c = 0; c < 3; ++c)
    if (weight[c] > 1 - on_boundary)
      return vertex_normals_[corners_[triangle.index][c]];
  for (int c = 0; c < 3; ++c)
    if (weight[(c + 2) % 3] < on_boundary)
      return edge_normals_[triangle.index][c];
  return face_normals_[triangle.index];
}

SurfaceTree::Closest SurfaceTree::closest(const Point& p, double within) const
{
  Closest best;
  best.squared_distance = within * within;
  const Triangle* found = nullptr;
  std::int32_t stack[64];
  int depth = 0;
  if (!boxes_.empty())
    stack[depth++] = 0;
  while (depth > 0)
  {
    const std::int32_t self = stack[--depth];
    const Box& box = boxes_[self];
    if (squared_distance(box.lower, box.upper, p) > best.squared_distance)
      continue;
    for (auto t = box.first; t < box.first + box.count; ++t)
    {
      const Triangle& triangle = triangles_[t];
      const Point c = physics::closest_point(p, triangle.corner[0], triangle.corner[1], triangle.corner[2]);
      const Point d = p - c;
      const double squared = dot(d, d);
      if (squared < best.squared_distance || (found == nullptr && squared <= best.squared_distance))
      {
        best.squared_distance = squared;
        best.point = c;
        found = &triangle;
      }
    }
    if (box.count == 0)
    {
      const std::int32_t left = self + 1, right = box.first;
      const double dl = squared_distance(boxes_[left].lower, boxes_[left].upper, p);
      const double dr = squared_distance(boxes_[right].lower, boxes_[right].upper, p);
      stack[depth++] = dl < dr ? right : left;
      stack[depth++] = dl < dr ? left : right;
    }
  }
  if (found != nullptr)
  {
    best.triangle = found->index;
    best.normal = pseudonormal(*found, best.point);
  }
  return best;
}

}  // namespace frontalis
