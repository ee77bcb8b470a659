#include "bake/mesh/triangle_tree.hpp"

#include <algorithm>
#include <numeric>

namespace frontalis
{
namespace
{

constexpr std::int32_t leaf_size = 4;

/// Closest point of a triangle (Ericson, Real-Time Collision Detection 2005, 5.1.5), with the feature that it lies on.
Vector3 closest_on_triangle(const Vector3& p, const Vector3& a, const Vector3& b, const Vector3& c,
                            std::int8_t& feature)
{
  const Vector3 ab = b - a, ac = c - a, ap = p - a;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0)
  {
    feature = 4;
    return a;
  }
  const Vector3 bp = p - b;
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3)
  {
    feature = 5;
    return b;
  }
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0)
  {
    feature = 1;
    return a + (d1 / (d1 - d3)) * ab;
  }
  const Vector3 cp = p - c;
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6)
  {
    feature = 6;
    return c;
  }
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0)
  {
    feature = 3;
    return a + (d2 / (d2 - d6)) * ac;
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
  {
    feature = 2;
    return b + ((d4 - d3) / ((d4 - d3) + (d5 - d6))) * (c - b);
  }
  feature = 0;
  const double scale = 1 / (va + vb + vc);
  return a + (vb * scale) * ab + (vc * scale) * ac;
}

}  // namespace

TriangleTree::TriangleTree(const TriangleMesh& mesh) : mesh_(&mesh), order_(mesh.triangles.size())
{
  std::iota(order_.begin(), order_.end(), 0);
  std::vector<Vector3> centroids;
  centroids.reserve(order_.size());
  for (const std::int32_t t : order_)
    centroids.push_back((1.0 / 3) * (corner(t, 0) + corner(t, 1) + corner(t, 2)));
  nodes_.reserve(order_.size());
  if (order_.empty())
    return;
  build(0, static_cast<std::int32_t>(order_.size()), centroids);
  corners_.reserve(order_.size());
  for (const std::int32_t t : order_)
    corners_.push_back({ corner(t, 0), corner(t, 1), corner(t, 2) });
  expansions_.reserve(nodes_.size());
  for (const Node& node : nodes_)
    expansions_.push_back(expand(node));
}

std::int32_t TriangleTree::build(std::int32_t begin, std::int32_t end, const std::vector<Vector3>& centroids)
{
  const auto index = static_cast<std::int32_t>(nodes_.size());
  nodes_.emplace_back();
  Node node;
  node.begin = begin;
  node.end = end;
  Box centres;
  for (std::int32_t i = begin; i < end; ++i)
  {
    const std::int32_t t = order_[static_cast<std::size_t>(i)];
    for (std::size_t c = 0; c < 3; ++c)
      node.box.include(corner(t, c));
    centres.include(centroids[static_cast<std::size_t>(t)]);
  }
  if (end - begin > leaf_size)
  {
    // halves by the median along the longest side; ties by number, so that the tree is always the same
    const Vector3 extent = centres.upper - centres.lower;
    const std::size_t axis =
        extent[0] >= extent[1] ? (extent[0] >= extent[2] ? 0 : 2) : (extent[1] >= extent[2] ? 1 : 2);
    const std::int32_t middle = (begin + end) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                     [&](std::int32_t s, std::int32_t t)
                     {
                       const double u = centroids[static_cast<std::size_t>(s)][axis];
                       const double v = centroids[static_cast<std::size_t>(t)][axis];
                       return u != v ? u < v : s < t;
                     });
    build(begin, middle, centroids);
    node.right = build(middle, end, centroids);
  }
  nodes_[static_cast<std::size_t>(index)] = node;
  return index;
}

ClosestPoint TriangleTree::closest(const Vector3& p, double bound, std::int32_t hint) const
{
  ClosestPoint best;
  if (nodes_.empty())
    return best;
  double squared = bound >= 1e150 ? 1e300 : bound * bound;
  const auto ask = [&](std::int32_t t, const Vector3& a, const Vector3& b, const Vector3& c)
  {
    std::int8_t feature = 0;
    const Vector3 q = closest_on_triangle(p, a, b, c, feature);
    const double d = dot(q - p, q - p);
    if (d < squared || (d == squared && (best.triangle < 0 || t < best.triangle)))
    {
      squared = d;
      best.point = q;
      best.triangle = t;
      best.feature = feature;
    }
  };
  if (hint >= 0)
    ask(hint, corner(hint, 0), corner(hint, 1), corner(hint, 2));
  struct Entry
  {
    std::int32_t node;
    double squared;
  };
  Entry stack[64];
  int top = 0;
  const double root = nodes_[0].box.squared_distance(p);
  if (root <= squared)
    stack[top++] = { 0, root };
  while (top > 0)
  {
    const Entry entry = stack[--top];
    if (entry.squared > squared)
      continue;
    const Node& node = nodes_[static_cast<std::size_t>(entry.node)];
    if (node.right == 0)
    {
      for (std::int32_t i = node.begin; i < node.end; ++i)
      {
        const auto& corners = corners_[static_cast<std::size_t>(i)];
        ask(order_[static_cast<std::size_t>(i)], corners[0], corners[1], corners[2]);
      }
      continue;
    }
    Entry near{ entry.node + 1, nodes_[static_cast<std::size_t>(entry.node + 1)].box.squared_distance(p) };
    Entry far{ node.right, nodes_[static_cast<std::size_t>(node.right)].box.squared_distance(p) };
    if (far.squared < near.squared)
      std::swap(near, far);
    if (far.squared <= squared)
      stack[top++] = far;
    if (near.squared <= squared)
      stack[top++] = near;
  }
  best.distance = best.triangle < 0 ? bound : std::sqrt(squared);
  return best;
}

bool TriangleTree::overlaps_triangle(const std::array<Vector3, 3>& corners, const Box& box)
{
  // separating axes of a box and a triangle (Akenine-Moeller 2001)
  const Vector3 centre = box.centre();
  const Vector3 half = 0.5 * (box.upper - box.lower);
  const Vector3 v[3] = { corners[0] - centre, corners[1] - centre, corners[2] - centre };
  for (std::size_t a = 0; a < 3; ++a)
  {
    if (std::min({ v[0][a], v[1][a], v[2][a] }) > half[a] || std::max({ v[0][a], v[1][a], v[2][a] }) < -half[a])
      return false;
  }
  const Vector3 normal = cross(v[1] - v[0], v[2] - v[0]);
  const double reach = half[0] * std::abs(normal[0]) + half[1] * std::abs(normal[1]) + half[2] * std::abs(normal[2]);
  if (std::abs(dot(normal, v[0])) > reach * (1 + 1e-12))
    return false;
  for (std::size_t e = 0; e < 3; ++e)
  {
    const Vector3 edge = v[(e + 1) % 3] - v[e];
    for (std::size_t a = 0; a < 3; ++a)
    {
      Vector3 unit{ 0, 0, 0 };
      unit[a] = 1;
      const Vector3 axis = cross(unit, edge);
      const double p = dot(axis, v[e]), q = dot(axis, v[(e + 2) % 3]);
      const double r = half[0] * std::abs(axis[0]) + half[1] * std::abs(axis[1]) + half[2] * std::abs(axis[2]);
      if (std::min(p, q) > r * (1 + 1e-12) || std::max(p, q) < -r * (1 + 1e-12))
        return false;
    }
  }
  return true;
}

bool TriangleTree::overlaps(const Box& box) const
{
  return visit([&](std::size_t node) { return nodes_[node].box.overlaps(box); },
               [&](std::size_t i) { return overlaps_triangle(corners_[i], box); });
}

void TriangleTree::gather(const Box& box, std::vector<std::int32_t>& triangles) const
{
  const std::size_t before = triangles.size();
  visit([&](std::size_t node) { return nodes_[node].box.overlaps(box); },
        [&](std::size_t i)
        {
          if (overlaps_triangle(corners_[i], box))
            triangles.push_back(order_[i]);
          return false;
        });
  std::sort(triangles.begin() + static_cast<std::ptrdiff_t>(before), triangles.end());
}

}  // namespace frontalis
