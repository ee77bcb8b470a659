#include "frontalis/render/face_appearance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace frontalis
{

namespace
{

using Point = std::array<double, 3>;

constexpr double half_width = 3.8e-3;     // half the width of the band where it is widest [m]
constexpr double inner_length = 9.0e-3;   // length of the band beyond the innermost landmark [m]
constexpr double bare = 12e-3;            // distance from the midline within which the band does not extend [m]
constexpr double outer_length = 11.0e-3;  // length of the band beyond the outermost landmark [m]
constexpr double inner_drop = 2e-3;       // height by which the inner end is lower [m]
constexpr double outer_drop = 3.5e-3;     // height by which the outer end is lower [m]
constexpr double density = 0.82;          // fraction of the skin that hair covers in the middle of the band
constexpr double widest = 0.3;            // where the band is widest and densest, as a fraction of its length

Point blend(const Point& a, const Point& b, double share)
{
  return { { a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1]), a[2] + share * (b[2] - a[2]) } };
}

double distance(const Point& a, const Point& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

Point wide(const std::array<float, 3>& p) { return { { p[0], p[1], p[2] } }; }

/// The line of the brow on one side, from its inner to its outer end; empty if there are fewer than two landmarks.
std::vector<Point> brow_line(const std::vector<std::string>& landmarks, const std::vector<std::array<float, 3>>& places,
                             const std::string& side)
{
  std::vector<Point> points;
  for (std::size_t landmark = 0; landmark < landmarks.size(); ++landmark)
  {
    const std::string& name = landmarks[landmark];
    if (name.rfind("brow", 0) == 0 && name.size() > side.size() &&
        name.compare(name.size() - side.size(), side.size(), side) == 0)
      points.push_back(wide(places[landmark]));
  }
  if (points.size() < 2)
    return {};
  std::sort(points.begin(), points.end(),
            [](const Point& a, const Point& b) { return std::abs(a[1]) < std::abs(b[1]); });
  const double inner = distance(points[0], points[1]);
  const double outer = distance(points[points.size() - 2], points.back());
  if (!(inner > 0) || !(outer > 0))
    return {};
  const double free = std::clamp(std::abs(points[0][1]) - bare, 1e-4, inner_length);
  points.insert(points.begin(), blend(points[0], points[1], -free / inner));
  points.push_back(blend(points[points.size() - 2], points.back(), 1 + outer_length / outer));
  points.front()[2] -= inner_drop;
  points.back()[2] -= outer_drop;
  return points;
}

/// Distance of a vertex from a line [m], and the closest point as a fraction of the line's length, 0..1.
std::pair<double, double> closest_on_line(const std::vector<Point>& points, const Point& vertex)
{
  double length = 0, best = 1e9, at = 0;
  for (std::size_t end = 1; end < points.size(); ++end)
  {
    const Point &a = points[end - 1], &b = points[end];
    const double edge = distance(a, b);
    double share = 0;
    for (int axis = 0; axis < 3; ++axis)
      share += (vertex[axis] - a[axis]) * (b[axis] - a[axis]) / (edge * edge);
    share = std::clamp(share, 0.0, 1.0);
    const double found = distance(vertex, blend(a, b, share));
    if (found < best)
    {
      best = found;
      at = length + share * edge;
    }
    length += edge;
  }
  return { best, at / length };
}

}  // namespace

std::vector<float> brow_cover(const std::vector<std::string>& landmarks,
                              const std::vector<std::array<float, 3>>& places,
                              const std::vector<std::array<float, 3>>& vertices)
{
  std::vector<float> cover(vertices.size(), 0.0f);
  for (const char* const side : { "_left", "_right" })
  {
    const auto points = brow_line(landmarks, places, side);
    if (points.empty())
      continue;
    for (std::size_t vertex = 0; vertex < cover.size(); ++vertex)
    {
      // hair is dense in the middle and soft at the border of the band, which is narrower and thinner towards its ends
      const auto [off, along] = closest_on_line(points, wide(vertices[vertex]));
      const double from_widest = along < widest ? (widest - along) / widest : (along - widest) / (1 - widest);
      const double width = half_width * (1 - (along < widest ? 0.25 : 0.7) * from_widest);
      const double share = std::clamp((1.5 * width - off) / (1.4 * width), 0.0, 1.0);
      const double thinned = density * (1 - (along < widest ? 0.55 : 0.3) * from_widest * from_widest);
      cover[vertex] = std::max(cover[vertex], static_cast<float>(thinned * share * share * (3 - 2 * share)));
    }
  }
  return cover;
}

}  // namespace frontalis
