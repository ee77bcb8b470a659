#include "bake/mesh/triangle_tree.hpp"

#include <cmath>

namespace frontalis
{
namespace
{

/// A group is far where its centre is at least this many times as far away as its farthest corner is from the centre.
/// The error of the winding number is then about 1e-3 (winding_number_test).
constexpr double far_ratio = 2.3;

}  // namespace

double winding_of_triangle(const Vector3d& p, const Vector3d& a, const Vector3d& b, const Vector3d& c)
{
  const Vector3d u = a - p, v = b - p, w = c - p;
  const double lu = u.norm(), lv = v.norm(), lw = w.norm();
  const double numerator = u.dot(v.cross(w));
  const double denominator = lu * lv * lw + u.dot(v) * lw + v.dot(w) * lu + w.dot(u) * lv;
  // a point in the plane of the triangle sees nothing of it
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
