#include "bake/mesh/triangle_tree.hpp"

#include "bake/mesh/closest_on_triangle.hpp"

#include <numeric>

namespace frontalis
{
namespace
{

constexpr std::int32_t leaf_size = 4;  // largest number of triangles in a leaf; a Four holds their boxes

/// Whether a box and a triangle overlap, by the separating axis theorem (Akenine-Moeller 2001).
bool overlap(const std::array<Vector3d, 3>& corners, const Box& box)
{
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

/// Whether the line from p along `direction` passes to the left of the edge from a to b, seen against `direction`. The
/// computation starts at the vertex with the lower index. The two triangles at an edge, which run along it in opposite
/// directions, therefore get opposite answers even if the line meets the edge.
bool left_of(const Vector3d& direction, const Vector3d& p, const Vector3d& a, const Vector3d& b, std::int32_t number_a,
             std::int32_t number_b)
{
  const bool ordered = number_a < number_b;
  const Vector3d first = (ordered ? a : b) - p, second = (ordered ? b : a) - p;
  return (direction.dot(first.cross(second)) >= 0) == ordered;
}

/// A group of triangles is far from a point if the distance of the point from the group's centre is at least this many
/// times the distance of the group's farthest corner from the centre. The error of the winding number is then about
/// 1e-3 (winding_number_test).
constexpr double far_ratio = 2.3;

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
  add_four(0);
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
    // Groups are halved along their longest side. Equal centroids are ordered by index, so that the tree is
    // reproducible.
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

void TriangleTree::add_four(std::int32_t node)
{
  const std::size_t index = fours_.size();
  fours_.emplace_back();
  Four four;
  for (std::size_t a = 0; a < 3; ++a)
    four.lower[a] = four.upper[a] = Eigen::Array4d::Constant(std::numeric_limits<double>::infinity());
  const auto place = [&four](std::size_t n, const Box& box, std::int32_t below)
  {
    for (std::size_t a = 0; a < 3; ++a)
    {
      four.lower[a][static_cast<Eigen::Index>(n)] = box.min()[static_cast<Eigen::Index>(a)];
      four.upper[a][static_cast<Eigen::Index>(n)] = box.max()[static_cast<Eigen::Index>(a)];
    }
    four.below[n] = below;
  };
  const auto is_leaf = [this](std::int32_t n) { return nodes_[n].right == 0; };
  if (is_leaf(node))
    for (std::int32_t i = nodes_[node].begin; i < nodes_[node].end; ++i)
    {
      const auto& [a, b, c] = corners_[i];
      place(static_cast<std::size_t>(i - nodes_[node].begin), Box(a).extend(b).extend(c), ~i);
    }
  else
  {
    std::vector<std::int32_t> members;
    for (const std::int32_t child : { node + 1, nodes_[node].right })
      if (is_leaf(child))
        members.push_back(child);
      else
        members.insert(members.end(), { child + 1, nodes_[child].right });
    for (std::size_t n = 0; n < members.size(); ++n)
    {
      place(n, nodes_[members[n]].box, static_cast<std::int32_t>(fours_.size()));
      add_four(members[n]);
    }
  }
  fours_[index] = four;
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
    std::int32_t below;
    double squared;
  };
  Entry stack[128];
  int top = 0;
  stack[top++] = { 0, 0 };
  while (top > 0)
  {
    const Entry entry = stack[--top];
    if (entry.squared > squared)
      continue;
    if (entry.below < 0)
    {
      ask(order_[~entry.below], corners_[~entry.below]);
      continue;
    }
    const Four& four = fours_[entry.below];
    Eigen::Array4d away = Eigen::Array4d::Zero();
    for (std::size_t a = 0; a < 3; ++a)
    {
      const double x = p[static_cast<Eigen::Index>(a)];
      away += (four.lower[a] - x).max(x - four.upper[a]).max(0).square();
    }
    // The nearest child is put on top of the stack.
    const int first = top;
    for (int c = 0; c < 4; ++c)
    {
      if (!(away[c] <= squared))
        continue;
      int place = top++;
      for (; place > first && stack[place - 1].squared < away[c]; --place)
        stack[place] = stack[place - 1];
      stack[place] = { four.below[c], away[c] };
    }
  }
  best.distance = best.triangle < 0 ? bound : std::sqrt(squared);
  return best;
}

bool TriangleTree::overlaps(const Box& box) const
{
  return visit([&](std::size_t node) { return nodes_[node].box.intersects(box); },
               [&](std::size_t i) { return overlap(corners_[i], box); });
}

void TriangleTree::gather(const Box& box, std::vector<std::int32_t>& triangles) const
{
  const std::size_t before = triangles.size();
  visit([&](std::size_t node) { return nodes_[node].box.intersects(box); },
        [&](std::size_t i)
        {
          if (overlap(corners_[i], box))
            triangles.push_back(order_[i]);
          return false;
        });
  std::sort(triangles.begin() + static_cast<std::ptrdiff_t>(before), triangles.end());
}

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

double winding_of_triangle(const Vector3d& p, const Vector3d& a, const Vector3d& b, const Vector3d& c)
{
  const Vector3d u = a - p, v = b - p, w = c - p;
  const double lu = u.norm(), lv = v.norm(), lw = w.norm();
  const double numerator = u.dot(v.cross(w));
  const double denominator = lu * lv * lw + u.dot(v) * lw + v.dot(w) * lu + w.dot(u) * lv;
  // The solid angle is 0 for a point in the plane of the triangle.
  if (numerator == 0)
    return 0;
  return std::atan2(numerator, denominator) / (2 * pi);
}

TriangleTree::Expansion TriangleTree::expand(const Node& range) const
{
  Expansion node;
  double area = 0;
  Vector3d weighted{ 0, 0, 0 };
  for (std::int32_t i = range.begin; i < range.end; ++i)
  {
    const auto& [a, b, c] = corners_[i];
    const double size = 0.5 * (b - a).cross(c - a).norm();
    area += size;
    weighted += (size / 3) * (a + b + c);
  }
  node.centre = area > 0 ? Vector3d((1 / area) * weighted) : range.box.center();
  for (std::int32_t i = range.begin; i < range.end; ++i)
  {
    const Vector3d a = corners_[i][0] - node.centre, b = corners_[i][1] - node.centre, c = corners_[i][2] - node.centre;
    node.squared_reach = std::max({ node.squared_reach, a.squaredNorm(), b.squaredNorm(), c.squaredNorm() });
    const Vector3d normal = 0.5 * (b - a).cross(c - a);
    const Vector3d middle = (1.0 / 3) * (a + b + c);
    node.dipole += normal;
    // Mean over the triangle of the product of the offsets j and k from the centre.
    const auto moment = [&](std::size_t j, std::size_t k)
    { return (a[j] * a[k] + b[j] * b[k] + c[j] * c[k] + 9 * middle[j] * middle[k]) / 12; };
    const double moments[6] = { moment(0, 0), moment(1, 1), moment(2, 2), moment(0, 1), moment(1, 2), moment(2, 0) };
    for (std::size_t r = 0; r < 3; ++r)
    {
      for (std::size_t j = 0; j < 3; ++j)
        node.first[3 * r + j] += normal[r] * middle[j];
      for (std::size_t m = 0; m < 6; ++m)
        node.second[6 * r + m] += normal[r] * moments[m];
    }
  }
  return node;
}

double TriangleTree::far_field(const Expansion& node, const Vector3d& p)
{
  const Vector3d r = node.centre - p;
  const double s2 = 1 / r.squaredNorm();
  const double s3 = s2 * std::sqrt(s2);
  const double s5 = s3 * s2;
  const auto& f = node.first;
  const auto& g = node.second;

  double sum = s3 * node.dipole.dot(r);
  const double trace = f[0] + f[4] + f[8];
  const Vector3d fr{ f[0] * r[0] + f[1] * r[1] + f[2] * r[2], f[3] * r[0] + f[4] * r[1] + f[5] * r[2],
                     f[6] * r[0] + f[7] * r[1] + f[8] * r[2] };
  sum += s3 * trace - 3 * s5 * r.dot(fr);

  // Half of second_ijk times the derivative d2/dxj dxk of r_i / r^3, which is -3 (d_ij r_k + d_ik r_j + d_jk r_i) / r^5
  // + 15 r_i r_j r_k / r^7.
  double diagonal = 0, cubic = 0;
  for (std::size_t i = 0; i < 3; ++i)
  {
    const double* m = g.data() + 6 * i;
    diagonal += r[i] * (m[0] + m[1] + m[2]);
    cubic += r[i] * (m[0] * r[0] * r[0] + m[1] * r[1] * r[1] + m[2] * r[2] * r[2] +
                     2 * (m[3] * r[0] * r[1] + m[4] * r[1] * r[2] + m[5] * r[2] * r[0]));
  }
  const double mixed = r[0] * (g[0] + g[6 + 3] + g[12 + 5]) + r[1] * (g[3] + g[6 + 1] + g[12 + 4]) +
                       r[2] * (g[5] + g[6 + 4] + g[12 + 2]);
  sum += -1.5 * s5 * (2 * mixed + diagonal) + 7.5 * s5 * s2 * cubic;
  return sum / (4 * pi);
}

double TriangleTree::winding_number(const Vector3d& p) const
{
  double sum = 0;
  visit(
      [&](std::size_t node)
      {
        const Expansion& expansion = expansions_[node];
        const Vector3d r = expansion.centre - p;
        const bool near = r.squaredNorm() <= far_ratio * far_ratio * expansion.squared_reach;
        if (!near)
          sum += far_field(expansion, p);
        return near;
      },
      [&](std::size_t i)
      {
        const auto& corners = corners_[i];
        sum += winding_of_triangle(p, corners[0], corners[1], corners[2]);
        return false;
      });
  return sum;
}

}  // namespace frontalis
