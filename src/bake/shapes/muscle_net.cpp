#include "bake/shapes/muscle_net.hpp"

#include "bake/mesh/surface.hpp"

namespace frontalis
{
namespace
{

// Distance between control points along a muscle.
constexpr double point_distance = 5e-3;  // [m]

double length_of(const std::vector<Vector3>& points, bool closed)
{
  double length = 0;
  for (std::size_t i = closed ? 0 : 1; i < points.size(); ++i)
    length += (to_vector(points[i]) - to_vector(points[i > 0 ? i - 1 : points.size() - 1])).norm();
  return length;
}

/// Point of a polyline at the fraction `share` of its length.
Vector3d along(const std::vector<Vector3>& points, double share)
{
  double left = share * length_of(points, false);
  for (std::size_t i = 1; i < points.size(); ++i)
  {
    const Vector3d a = to_vector(points[i - 1]), b = to_vector(points[i]);
    const double part = (b - a).norm();
    if (left <= part || i + 1 == points.size())
      return a + std::min(1.0, part > 0 ? left / part : 0.0) * (b - a);
    left -= part;
  }
  return to_vector(points.front());
}

/// Catmull-Rom interpolation of values at 0, 1, 2, ...
template <class Value, class At>
Value interpolate(const At& at, int count, double t)
{
  const int i = std::min(count - 2, std::max(0, static_cast<int>(t)));
  const double s = t - i;
  const Value p1 = at(i), p2 = at(i + 1);
  const Value p0 = i > 0 ? at(i - 1) : Value(2 * p1 - p2);
  const Value p3 = i + 2 < count ? at(i + 2) : Value(2 * p2 - p1);
  return 0.5 *
         (2 * p1 + (p2 - p0) * s + (2 * p0 - 5 * p1 + 4 * p2 - p3) * s * s + (3 * p1 - p0 - 3 * p2 + p3) * s * s * s);
}

/// Point of a closed loop through `points`, at the fraction `share` of their number.
Vector3d around(const std::vector<Vector3>& points, double share)
{
  const int count = static_cast<int>(points.size());
  return interpolate<Vector3d>([&](int i) { return to_vector(points[static_cast<std::size_t>(i) % points.size()]); },
                               3 * count, count + share * count);
}

}  // namespace

double MuscleSheet::position(double u, double s) const
{
  return (ring_ ? s : u) * static_cast<double>(curves_.size() - 1);
}

Vector3d MuscleSheet::at(double u, double s) const
{
  return interpolate<Vector3d>([&](int c) { return ring_ ? around(curves_[c], u) : along(curves_[c], s); },
                               static_cast<int>(curves_.size()), position(u, s));
}

double MuscleSheet::between(const std::vector<double>& values, double u, double s) const
{
  return interpolate<double>([&](int c) { return values[c]; }, static_cast<int>(values.size()), position(u, s));
}

double MuscleSheet::relative_thickness(double u, double s) const
{
  const double edge = std::abs(2 * s - 1), end = ring_ ? 0 : std::abs(2 * u - 1);
  return (1 - 0.6 * edge * edge * edge) / 0.85 * (1 - 0.4 * std::pow(end, 4));
}

ControlNet MuscleSheet::net(const std::function<std::array<Vector3d, 2>(double u, double s)>& sides) const
{
  // With fewer control points, the spline would smooth away up to half of the cross-section.
  constexpr int least_along = 12, least_across = 13;
  double reach = 0, width = 0;
  for (std::size_t c = 0; c < curves_.size(); ++c)
  {
    width = std::max(width, length_of(curves_[c], ring_));
    if (c > 0)
      reach += (along(curves_[c], 0.5) - along(curves_[c - 1], 0.5)).norm();
  }
  // A ring's curves are loops along which its fibres run. In other muscles fibres run from curve to curve.
  if (ring_)
    std::swap(reach, width);
  const auto points_over = [](double length, int least)
  {
    check_edges(point_distance, length);
    return std::max(least, static_cast<int>(std::ceil(length / point_distance)) + 1);
  };
  const int n = points_over(reach, least_along), across = points_over(width, least_across);
  ControlNet net;
  net.size = { n, across, 2 };
  net.ring = ring_;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < across; ++j)
    {
      const double u = ring_ ? static_cast<double>(i) / n : static_cast<double>(i) / (n - 1);
      for (const Vector3d& side : sides(u, static_cast<double>(j) / (across - 1)))
        net.points.push_back(to_array(side));
    }
  return net;
}

ControlNet curved_muscle_net(const Shape& shape)
{
  const MuscleSheet sheet(shape.curves, shape.ring);
  return sheet.net(
      [&](double u, double s) -> std::array<Vector3d, 2>
      {
        // The normal is that of the surface through points a little farther along and across.
        constexpr double step = 1e-3;
        const double u0 = shape.ring ? u : std::max(0.0, u - step), s0 = std::max(0.0, s - step);
        const Vector3d corner = sheet.at(u0, s0);
        const Vector3d normal =
            (sheet.at(u0 + step, s0) - corner).cross(sheet.at(u0, std::min(1.0, s0 + step)) - corner).normalized();
        const Vector3d half = 0.5 * shape.thickness * sheet.relative_thickness(u, s) * normal;
        const Vector3d middle = sheet.at(u, s);
        return { middle - half, middle + half };
      });
}

NurbsVolume volume_of(const ControlNet& net)
{
  const auto axis = [&net](std::size_t a)
  { return SplineAxis(std::min(3, net.size[a] - 1), net.size[a], a == 0 && net.ring); };
  std::vector<Vector3d> points(net.points.size());
  std::transform(net.points.begin(), net.points.end(), points.begin(), to_vector);
  return NurbsVolume({ { axis(0), axis(1), axis(2) } }, points, net.weights);
}

TriangleMesh net_surface(const ControlNet& net, double edge, bool closed)
{
  const NurbsVolume volume = volume_of(net);
  const auto at = [&](double u, double v, double w) { return volume.at({ u, v, w }).position; };
  const auto length = [&](const Vector3d& from, const Vector3d& to)
  {
    double sum = 0;
    for (int i = 0; i < 8; ++i)
      sum += (at(from[0] + (to[0] - from[0]) * (i + 1) / 8, from[1] + (to[1] - from[1]) * (i + 1) / 8, 0.5) -
              at(from[0] + (to[0] - from[0]) * i / 8, from[1] + (to[1] - from[1]) * i / 8, 0.5))
                 .norm();
    return sum;
  };
  const auto parts = [&](double l)
  {
    check_edges(edge, l);
    return 2 * std::max(1, static_cast<std::int32_t>(std::ceil(0.5 * l / edge)));
  };
  const std::int32_t n = std::max(net.ring ? 12 : 2, parts(length({ 0, 0.5, 0 }, { 1, 0.5, 0 })));
  const std::int32_t m = parts(std::max(length({ 0.5, 0, 0 }, { 0.5, 1, 0 }), length({ 0, 0, 0 }, { 0, 1, 0 })));
  const auto place = [&](std::int32_t i, std::int32_t j, std::int32_t k)
  { return at(net.ring && i == n ? 0 : static_cast<double>(i) / n, static_cast<double>(j) / m, k); };
  TriangleMesh mesh;
  add_sheet(mesh, n, m, [&](std::int32_t i, std::int32_t j) { return place(i, j, 1); });
  if (!closed)
    return mesh;
  add_sheet(mesh, m, n, [&](std::int32_t j, std::int32_t i) { return place(i, j, 0); });
  add_sheet(mesh, n, 1, [&](std::int32_t i, std::int32_t k) { return place(i, 0, k); });
  add_sheet(mesh, 1, n, [&](std::int32_t k, std::int32_t i) { return place(i, m, k); });
  if (!net.ring)
  {
    add_sheet(mesh, 1, m, [&](std::int32_t k, std::int32_t j) { return place(0, j, k); });
    add_sheet(mesh, m, 1, [&](std::int32_t j, std::int32_t k) { return place(n, j, k); });
  }
  return mesh;
}

}  // namespace frontalis
