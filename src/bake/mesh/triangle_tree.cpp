#include "bake/mesh/triangle_tree.hpp"

#include <algorithm>
#include <numeric>

namespace frontalis
{
namespace
{

constexpr std::int32_t leaf_size = 4;  // triangles

/// Closest point of a triangle (Ericson, Real-Time Collision Detection 2005, 5.1.5), with the feature that it lies on.
Vector3d closest_on_triangle(const Vector3d& p, const Vector3d& a, const Vector3d& b, const Vector3d& c,
                             std::int8_t& feature)
{
  const Vector3d ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0)
  {
    feature = 4;
    return a;
  }
  const Vector3d bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
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
  const Vector3d cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
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
  std::vector<Vector3d> centroids;
  centroids.reserve(order_.size());
  for (const Triangle& t : mesh.triangles)
  {
    const auto [a, b, c] = corners(mesh, t);
    centroids.emplace_back((1.0 / 3) * (a + b + c));
  }
  nodes_.reserve(order_.size());
  if (order_.empty())
    return;
  build(0, static_cast<std::int32_t>(order_.size()), centroids);
  corners_.reserve(order_.size());
  for (const std::int32_t t : order_)
    corners_.push_back(corners(mesh, mesh.triangles[t]));
  expansions_.reserve(nodes_.size());
  for (const Node& node : nodes_)
    expansions_.push_back(expand(node));
}

std::int32_t TriangleTree::build(std::int32_t begin, std::int32_t end, const std::vector<Vector3d>& centroids)
{
  const auto index = static_cast<std::int32_t>(nodes_.size());
  nodes_.emplace_back();
  Node node;
  node.begin = begin;
  node.end = end;
  Box centres;
  for (std::int32_t i = begin; i < end; ++i)
  {
    const std::int32_t t = order_[i];
    for (const Vector3d& corner : corners(*mesh_, mesh_->triangles[t]))
      node.box.extend(corner);
    centres.extend(centroids[t]);
  }
  if (end - begin > leaf_size)
  {
    // two halves along the longest side; equal centroids are ordered by number, so that the tree is always the same
    Eigen::Index axis = 0;
    centres.sizes().maxCoeff(&axis);
    const std::int32_t middle = (begin + end) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                     [&](std::int32_t s, std::int32_t t)
                     {
                       const double u = centroids[s][axis];
                       const double v = centroids[t][axis];
                       return u != v ? u < v : s < t;
                     });
    build(begin, middle, centroids);
    node.right = build(middle, end, centroids);
  }
  nodes_[index] = node;
  return index;
}

ClosestPoint TriangleTree::closest(const Vector3d& p, double bound, std::int32_t hint) const
{
  ClosestPoint best;
  if (nodes_.empty())
    return best;
  double squared = bound >= 1e150 ? 1e300 : bound * bound;
  const auto ask = [&](std::int32_t t, const std::array<Vector3d, 3>& corners)
  {
    std::int8_t feature = 0;
    const Vector3d q = closest_on_triangle(p, corners[0], corners[1], corners[2], feature);
    const double d = (q - p).squaredNorm();
    if (d < squared || (d == squared && (best.triangle < 0 || t < best.triangle)))
    {
      squared = d;
      best.point = q;
      best.triangle = t;
      best.feature = feature;
    }
  };
  if (hint >= 0)
    ask(hint, corners(*mesh_, mesh_->triangles[hint]));
  struct Entry
  {
    std::int32_t node;
    double squared;
  };
  Entry stack[64];
  int top = 0;
  const double root = nodes_[0].box.squaredExteriorDistance(p);
  if (root <= squared)
    stack[top++] = { 0, root };
  while (top > 0)
  {
    const Entry entry = stack[--top];
    if (entry.squared > squared)
      continue;
    const Node& node = nodes_[entry.node];
    if (node.right == 0)
    {
      for (std::int32_t i = node.begin; i < node.end; ++i)
        ask(order_[i], corners_[i]);
      continue;
    }
    Entry near{ entry.node + 1, nodes_[entry.node + 1].box.squaredExteriorDistance(p) };
    Entry far{ node.right, nodes_[node.right].box.squaredExteriorDistance(p) };
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

bool TriangleTree::overlaps_triangle(const std::array<Vector3d, 3>& corners, const Box& box)
{
  // separating axes of a box and a triangle (Akenine-Moeller 2001)
  const Vector3d centre = box.center();
  const Vector3d half = 0.5 * box.sizes();
  const Vector3d v[3] = { corners[0] - centre, corners[1] - centre, corners[2] - centre };
  for (int a = 0; a < 3; ++a)
    if (std::min({ v[0][a], v[1][a], v[2][a] }) > half[a] || std::max({ v[0][a], v[1][a], v[2][a] }) < -half[a])
      return false;
  const Vector3d normal = (v[1] - v[0]).cross(v[2] - v[0]);
  const double reach = half.dot(normal.cwiseAbs());
  if (std::abs(normal.dot(v[0])) > reach * (1 + 1e-12))
    return false;
  for (std::size_t e = 0; e < 3; ++e)
  {
    const Vector3d edge = v[(e + 1) % 3] - v[e];
    for (int a = 0; a < 3; ++a)
    {
      const Vector3d axis = Vector3d::Unit(a).cross(edge);
      const double p = axis.dot(v[e]), q = axis.dot(v[(e + 2) % 3]);
      const double r = half.dot(axis.cwiseAbs());
      if (std::min(p, q) > r * (1 + 1e-12) || std::max(p, q) < -r * (1 + 1e-12))
        return false;
    }
  }
  return true;
}

bool TriangleTree::overlaps(const Box& box) const
{
  return visit([&](std::size_t node) { return nodes_[node].box.intersects(box); },
               [&](std::size_t i) { return overlaps_triangle(corners_[i], box); });
}

void TriangleTree::gather(const Box& box, std::vector<std::int32_t>& triangles) const
{
  const std::size_t before = triangles.size();
  visit([&](std::size_t node) { return nodes_[node].box.intersects(box); },
        [&](std::size_t i)
        {
          if (overlaps_triangle(corners_[i], box))
            triangles.push_back(order_[i]);
          return false;
        });
  std::sort(triangles.begin() + static_cast<std::ptrdiff_t>(before), triangles.end());
}

}  // namespace frontalis
