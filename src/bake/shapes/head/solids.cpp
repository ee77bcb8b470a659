#include "bake/shapes/head/solids.hpp"

namespace frontalis
{
namespace
{

using Vector2d = Eigen::Vector2d;

/// Points of the Catmull-Rom spline through `points`, in their order, with `parts` pieces from each to the next.
template <class Vector>
std::vector<Vector> spline(const std::vector<Vector>& points, bool closed, int parts)
{
  const auto n = static_cast<std::ptrdiff_t>(points.size());
  const auto at = [&](std::ptrdiff_t i) -> Vector
  {
    if (closed)
      return points[(i + n) % n];
    return i < 0 ? Vector(2 * points[0] - points[1]) : i >= n ? Vector(2 * points[n - 1] - points[n - 2]) : points[i];
  };
  std::vector<Vector> result;
  for (std::ptrdiff_t i = 0; i < (closed ? n : n - 1); ++i)
    for (int k = 0; k < parts; ++k)
    {
      const double s = static_cast<double>(k) / parts;
      const Vector a = at(i - 1), b = at(i), c = at(i + 1), d = at(i + 2);
      result.push_back(
          0.5 * (2 * b + (c - a) * s + (2 * a - 5 * b + 4 * c - d) * s * s + (3 * b - a - 3 * c + d) * s * s * s));
    }
  if (!closed)
    result.push_back(points.back());
  return result;
}

/// Projection of p on the segment from a to b, as a fraction of its length, 0 to 1.
template <class Vector>
double share_of(const Vector& p, const Vector& a, const Vector& b)
{
  const double squared = (b - a).squaredNorm();
  return squared > 0 ? std::min(1.0, std::max(0.0, (p - a).dot(b - a) / squared)) : 0;
}

/// Signed distance from a closed polygon, negative inside (even-odd rule).
double distance(const Vector2d& p, const std::vector<Vector2d>& polygon)
{
  double least = 1e300;
  bool inside = false;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++)
  {
    const Vector2d &a = polygon[j], &b = polygon[i];
    least = std::min(least, (p - a - share_of(p, a, b) * (b - a)).squaredNorm());
    if ((a[1] > p[1]) != (b[1] > p[1]) && p[0] < (b[0] - a[0]) * (p[1] - a[1]) / (b[1] - a[1]) + a[0])
      inside = !inside;
  }
  return (inside ? -1 : 1) * std::sqrt(least);
}

double ellipsoid(const Vector3d& p, const Vector3d& centre, const Vector3d& axes)
{
  const Vector3d q = (p - centre).cwiseQuotient(axes);
  const double n = q.norm(), g = q.cwiseQuotient(axes).norm();
  return g > 1e-9 ? n * (n - 1) / g : -axes.minCoeff();
}

/// Distance from a box with rounded edges about the origin.
double rounded_box(const Vector3d& p, const Vector3d& half, double radius)
{
  const Vector3d q = p.cwiseAbs() - half + Vector3d::Constant(radius);
  return q.cwiseMax(0).norm() + std::min(q.maxCoeff(), 0.0) - radius;
}

}  // namespace

double smooth_max(double a, double b, double radius)
{
  const double h = std::max(0.0, radius - std::abs(a - b)) / std::max(radius, 1e-9);
  return std::max(a, b) + 0.25 * h * h * radius;
}

HeadSolid::HeadSolid(const HeadTemplate::Solid& solid)
    : kind_(solid.kind),
      axis_(solid.axis),
      from_(solid.from),
      to_(solid.to),
      depth_(solid.depth),
      centre_(to_vector(solid.centre)),
      axes_(to_vector(solid.axes))
{
  std::vector<Vector3d> points(solid.points.size());
  std::transform(solid.points.begin(), solid.points.end(), points.begin(), to_vector);
  if (kind_ == Kind::outline)
  {
    std::vector<Vector2d> flat;
    flat.reserve(points.size());
    for (const Vector3d& p : points)
      flat.emplace_back(p.head<2>());
    polygon_ = spline(flat, true, 5);
  }
  else if (kind_ == Kind::tube)
  {
    // Radii are interpolated as a fourth coordinate.
    std::vector<Eigen::Vector4d> with_radius;
    with_radius.reserve(points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
      with_radius.emplace_back(points[i][0], points[i][1], points[i][2], solid.sizes[i][0]);
    for (const Eigen::Vector4d& p : spline(with_radius, false, 4))
    {
      line_.emplace_back(p.head<3>());
      radii_.push_back(p[3]);
    }
  }
  else if (kind_ == Kind::teeth)
    place_teeth(spline(points, false, 6), solid.sizes);
}

void HeadSolid::place_teeth(const std::vector<Vector3d>& arch, const std::vector<Vector3>& sizes)
{
  double begin = 0;
  for (const Vector3& size : sizes)
  {
    // The tooth's middle is found by its distance along the arch.
    double left = begin + 0.5 * size[0];
    begin += size[0];
    std::size_t i = 1;
    while (i + 1 < arch.size() && left > (arch[i] - arch[i - 1]).norm())
    {
      left -= (arch[i] - arch[i - 1]).norm();
      ++i;
    }
    const Vector3d along = (arch[i] - arch[i - 1]).normalized();
    teeth_.push_back({ arch[i - 1] + left * along, along, to_vector(size) });
  }
}

double HeadSolid::row_of_teeth(const Vector3d& p) const
{
  constexpr double gap = 0.15e-3, root = 3e-3;  // [m]
  const double height = from_ - to_;            // signed height of the crown, from the edge to the neck
  // `up` is 0 at the edge and 1 at the neck.
  const double up = std::min(1.0, std::max(0.0, (p[2] - to_) / height));
  double least = 1e300;
  for (const Tooth& tooth : teeth_)
  {
    const Vector3d away = p - tooth.at;
    const double along = away.dot(tooth.along);
    const double across = away.dot(Vector3d(tooth.along[1], -tooth.along[0], 0));
    const double width = tooth.size[0] * (1 - 0.2 * up * up) - gap;
    const double depth = tooth.size[1] + (tooth.size[2] - tooth.size[1]) * std::sqrt(up);
    const double half = 0.5 * (std::abs(height) + root);
    const double middle = to_ + std::copysign(half, height);
    const Vector3d size(0.5 * width, 0.5 * depth, half);
    least = std::min(least, rounded_box({ along, across, p[2] - middle }, size, 0.8 * std::min(size[0], size[1])));
  }
  return least;
}

double HeadSolid::outline(const Vector3d& p) const
{
  const Vector2d q(p[axis_ == 0 ? 1 : 0], p[axis_ == 2 ? 1 : 2]);
  double f = 0;
  if (depth_ != 0)
  {
    // A cone with its apex at `centre`. The outline lies at the distance `depth` from the apex.
    const Vector2d apex(centre_[axis_ == 0 ? 1 : 0], centre_[axis_ == 2 ? 1 : 2]);
    const double scale = std::max(0.05, (p[axis_] - centre_[axis_]) / depth_);
    f = scale * distance(apex + (q - apex) / scale, polygon_);
  }
  else
    f = distance(q, polygon_);
  return std::max(f, std::max(from_ - p[axis_], p[axis_] - to_));
}

double HeadSolid::operator()(const Vector3d& p, double hull) const
{
  switch (kind_)
  {
    case Kind::below:
      return hull + depth_;
    case Kind::above:
      return -hull - depth_;
    case Kind::ellipsoid:
      return ellipsoid(p, centre_, axes_);
    case Kind::outline:
      return outline(p);
    case Kind::teeth:
      return row_of_teeth(p);
    case Kind::tube:
      break;
  }
  double least = 1e300;
  for (std::size_t i = 1; i < line_.size(); ++i)
  {
    const double s = share_of(p, line_[i - 1], line_[i]);
    least = std::min(least, (p - line_[i - 1] - s * (line_[i] - line_[i - 1])).norm() - radii_[i - 1] -
                                s * (radii_[i] - radii_[i - 1]));
  }
  return least;
}

}  // namespace frontalis
