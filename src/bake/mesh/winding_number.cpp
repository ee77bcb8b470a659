#include "bake/mesh/triangle_tree.hpp"

#include <cmath>

namespace frontalis
{
namespace
{

constexpr double pi = 3.14159265358979323846;

/// A group counts as far from this many times its reach: the error of the series is then some 1e-3 (see the test).
constexpr double far_ratio = 2.3;

}  // namespace

double winding_of_triangle(const Vector3& p, const Vector3& a, const Vector3& b, const Vector3& c)
{
  const Vector3 u = a - p, v = b - p, w = c - p;
  const double lu = norm(u), lv = norm(v), lw = norm(w);
  const double numerator = dot(u, cross(v, w));
  const double denominator = lu * lv * lw + dot(u, v) * lw + dot(v, w) * lu + dot(w, u) * lv;
  // a point in the plane of the triangle sees nothing of it
  if (numerator == 0)
    return 0;
  return std::atan2(numerator, denominator) / (2 * pi);
}

TriangleTree::Expansion TriangleTree::expand(const Node& range) const
{
  Expansion node;
  const auto count = static_cast<std::size_t>(range.end - range.begin);
  double area = 0;
  Vector3 weighted{ 0, 0, 0 };
  for (std::size_t i = 0; i < count; ++i)
  {
    const std::int32_t t = order_[static_cast<std::size_t>(range.begin) + i];
    const Vector3 &a = corner(t, 0), &b = corner(t, 1), &c = corner(t, 2);
    const double size = 0.5 * norm(cross(b - a, c - a));
    area += size;
    weighted = weighted + (size / 3) * (a + b + c);
  }
  node.centre = area > 0 ? (1 / area) * weighted : range.box.centre();
  for (std::size_t i = 0; i < count; ++i)
  {
    const std::int32_t t = order_[static_cast<std::size_t>(range.begin) + i];
    const Vector3 a = corner(t, 0) - node.centre, b = corner(t, 1) - node.centre, c = corner(t, 2) - node.centre;
    node.squared_reach = std::max({ node.squared_reach, dot(a, a), dot(b, b), dot(c, c) });
    const Vector3 normal = 0.5 * cross(b - a, c - a);
    const Vector3 middle = (1.0 / 3) * (a + b + c);
    node.dipole = node.dipole + normal;
    // mean of offset j times offset k over the triangle
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

double TriangleTree::far_field(const Expansion& node, const Vector3& p)
{
  const Vector3 r = node.centre - p;
  const double s2 = 1 / dot(r, r);
  const double s3 = s2 * std::sqrt(s2);
  const double s5 = s3 * s2;
  const auto& f = node.first;
  const auto& g = node.second;

  double sum = s3 * dot(node.dipole, r);
  const double trace = f[0] + f[4] + f[8];
  const Vector3 fr{ f[0] * r[0] + f[1] * r[1] + f[2] * r[2], f[3] * r[0] + f[4] * r[1] + f[5] * r[2],
                    f[6] * r[0] + f[7] * r[1] + f[8] * r[2] };
  sum += s3 * trace - 3 * s5 * dot(r, fr);

  // half of second_ijk times d2/dxj dxk of r_i / r^3 = -3 (d_ij r_k + d_ik r_j + d_jk r_i) / r^5 + 15 r_i r_j r_k / r^7
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

double TriangleTree::winding_number(const Vector3& p) const
{
  double sum = 0;
  visit(
      [&](std::size_t node)
      {
        const Expansion& expansion = expansions_[node];
        const Vector3 r = expansion.centre - p;
        const bool near = dot(r, r) <= far_ratio * far_ratio * expansion.squared_reach;
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
