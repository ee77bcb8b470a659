#include "solver/contact/surface_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

namespace frontalis
{
namespace
{

using Point = SurfaceSearch::Point;
using Box = SurfaceSearch::Box;
using Triangle = SurfaceSearch::Triangle;

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

}  // namespace

SurfaceTree::SurfaceTree(const TriangleMesh& mesh)
{
  const std::size_t count = mesh.triangles.size();
  struct Edge
  {
    Point normal{ 0, 0, 0 };
    int triangles = 0;
  };
  std::vector<Point> vertex_normal(mesh.vertices.size(), Point{ 0, 0, 0 });
  std::map<std::pair<std::int32_t, std::int32_t>, Edge> edges;
  const auto edge_of = [](std::int32_t a, std::int32_t b) { return std::make_pair(std::min(a, b), std::max(a, b)); };
  for (std::size_t t = 0; t < count; ++t)
  {
    const auto& corner = mesh.triangles[t];
    Triangle triangle{};
    for (int c = 0; c < 3; ++c)
      triangle.corner[c] = point(mesh.vertices[corner[c]]);
    triangle.index = static_cast<std::int32_t>(t);
    triangle.face_normal =
        unit(cross(triangle.corner[1] - triangle.corner[0], triangle.corner[2] - triangle.corner[0]));
    triangles_.push_back(triangle);
    for (int c = 0; c < 3; ++c)
    {
      const Point& here = triangle.corner[c];
      const double weight = angle(triangle.corner[(c + 1) % 3] - here, triangle.corner[(c + 2) % 3] - here);
      vertex_normal[corner[c]] = vertex_normal[corner[c]] + weight * triangle.face_normal;
      Edge& edge = edges[edge_of(corner[c], corner[(c + 1) % 3])];
      edge.normal = edge.normal + triangle.face_normal;
      ++edge.triangles;
    }
  }
  std::vector<bool> on_rim(mesh.vertices.size(), false);
  for (const auto& edge : edges)
    if (edge.second.triangles == 1)
      on_rim[edge.first.first] = on_rim[edge.first.second] = true;
  for (std::size_t t = 0; t < count; ++t)
    for (int c = 0; c < 3; ++c)
    {
      const auto& corner = mesh.triangles[t];
      const Edge& edge = edges[edge_of(corner[c], corner[(c + 1) % 3])];
      triangles_[t].vertex_normal[c] = unit(vertex_normal[corner[c]]);
      triangles_[t].edge_normal[c] = unit(edge.normal);
      triangles_[t].rim |= (edge.triangles == 1 ? 1 << c : 0) | (on_rim[corner[c]] ? 8 << c : 0);
    }
  // triangles without area are covered by their neighbours
  triangles_.erase(std::remove_if(triangles_.begin(), triangles_.end(),
                                  [](const Triangle& t) { return !(dot(t.face_normal, t.face_normal) > 0); }),
                   triangles_.end());
  if (!triangles_.empty())
    build(0, static_cast<std::int32_t>(triangles_.size()));
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

}  // namespace frontalis
