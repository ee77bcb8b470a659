#include "bake/shapes/head/head.hpp"
#include "bake/shapes/head/muscle_net.hpp"

namespace frontalis
{
namespace
{

// Distance between control points along a muscle.
constexpr double point_distance = 5e-3;  // [m]
// A muscle stays at least this far below the skin, where there is room: the thickness of the dermis.
constexpr double least_cover = 1.8e-3;  // [m]

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

/// Thickness at fractions of a muscle's length and breadth, divided by the mean thickness in its middle. Edges are
/// thin.
double cross_section(double along, double across)
{
  const double edge = std::abs(2 * across - 1), end = std::abs(2 * along - 1);
  return (1 - 0.6 * edge * edge * edge) / 0.85 * (1 - 0.4 * std::pow(end, 4));
}

/// Point of a closed loop through `points`, at the fraction `share` of their number.
Vector3d around(const std::vector<Vector3>& points, double share)
{
  const int count = static_cast<int>(points.size());
  return interpolate<Vector3d>([&](int i) { return to_vector(points[static_cast<std::size_t>(i) % points.size()]); },
                               3 * count, count + share * count);
}

}  // namespace

ControlNet Head::left_net(const HeadTemplate::Muscle& muscle) const
{
  const auto& curves = muscle.curves;
  const int count = static_cast<int>(curves.size());
  double reach = 0, width = 0;
  for (int c = 0; c < count; ++c)
  {
    width = std::max(width, length_of(curves[c].points, muscle.ring));
    if (c > 0)
      reach += (along(curves[c].points, 0.5) - along(curves[c - 1].points, 0.5)).norm();
  }
  // A ring's curves are loops along which its fibres run. In other muscles fibres run from curve to curve.
  if (muscle.ring)
    std::swap(reach, width);
  const auto points_over = [](double length, int least)
  { return std::max(least, static_cast<int>(std::ceil(length / point_distance)) + 1); };
  const int n = points_over(reach, 4), across = points_over(width, 3);
  ControlNet net;
  net.size = { n, across, 2 };
  net.ring = muscle.ring;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < across; ++j)
    {
      const double s = static_cast<double>(j) / (across - 1);
      const double u = muscle.ring ? static_cast<double>(i) / n : static_cast<double>(i) / (n - 1);
      // Position between the curves.
      const double t = (muscle.ring ? s : u) * (count - 1);
      const Vector3d p = interpolate<Vector3d>(
          [&](int c) { return muscle.ring ? around(curves[c].points, u) : along(curves[c].points, s); }, count, t);
      const Below place = below(p);
      const double room = place.thickness;
      const double depth = interpolate<double>(
          [&](int c) { return curves[c].below < 0 ? curves[c].depth * room : curves[c].below; }, count, t);
      // A muscle with a depth of its own (Curve::below) may pass below a bone.
      const bool free = std::any_of(curves.begin() + static_cast<int>(t),
                                    curves.begin() + std::min(count, static_cast<int>(std::ceil(t)) + 1),
                                    [](const auto& curve) { return curve.below >= 0; });
      const double thickness = muscle.thickness * cross_section(muscle.ring ? 0.5 : u, s);
      const double half = 0.5 * (free ? thickness : std::min(thickness, 0.8 * room));
      const double lowest = free ? depth : std::max(0.55 * room, room - half - 0.1e-3);
      const double highest = std::min(lowest, std::min(least_cover, 0.3 * room) + half);
      const double middle = std::min(lowest, std::max(highest, depth));
      net.points.push_back(to_array(place.skin - (middle + half) * place.normal));
      net.points.push_back(to_array(place.skin - (middle - half) * place.normal));
    }
  return net;
}

NurbsVolume volume_of(const ControlNet& net)
{
  const auto axis = [&net](std::size_t a)
  { return SplineAxis(std::min(3, net.size[a] - 1), net.size[a], a == 0 && net.ring); };
  std::vector<Vector3d> points(net.points.size());
  std::transform(net.points.begin(), net.points.end(), points.begin(), to_vector);
  return NurbsVolume({ { axis(0), axis(1), axis(2) } }, points, net.weights);
}

TriangleMesh net_surface(const ControlNet& net, double edge)
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
  const auto parts = [&](double l) { return 2 * std::max(1, static_cast<std::int32_t>(std::ceil(0.5 * l / edge))); };
  const std::int32_t n = std::max(net.ring ? 12 : 2, parts(length({ 0, 0.5, 0 }, { 1, 0.5, 0 })));
  const std::int32_t m = parts(std::max(length({ 0.5, 0, 0 }, { 0.5, 1, 0 }), length({ 0, 0, 0 }, { 0, 1, 0 })));
  const auto place = [&](std::int32_t i, std::int32_t j, std::int32_t k)
  { return at(net.ring && i == n ? 0 : static_cast<double>(i) / n, static_cast<double>(j) / m, k); };
  TriangleMesh mesh;
  add_sheet(mesh, n, m, [&](std::int32_t i, std::int32_t j) { return place(i, j, 1); });
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
