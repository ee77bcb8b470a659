#include "frontalis/study/wrinkles.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace frontalis
{
namespace
{

using Vector = Eigen::Vector3d;

constexpr double piece_size =
    0.2;                       // edge of the pieces of skin that a fit uses, over the standard deviation of its window
constexpr double reach = 2.5;  // of the window: pieces farther away do not count, over its standard deviation
constexpr std::size_t vertices_per_report = 256;  // vertices between two calls of `progress`

Vector to_eigen(const std::array<float, 3>& p) { return { p[0], p[1], p[2] }; }

// The place of a point in a grid of cubes.
std::array<int, 3> cube_of(const Vector& p, double edge)
{
  const auto along = [&](int axis) { return static_cast<int>(std::floor(p[axis] / edge)); };
  return { along(0), along(1), along(2) };
}

// A piece of the skin: its mean place and normal, and its area.
struct Piece
{
  Vector place = Vector::Zero(), normal = Vector::Zero();
  double area = 0;
};

// Pieces sorted into cubes of space, so that those near a point are found quickly.
class Cells
{
public:
  Cells(const std::vector<Piece>& pieces, double edge) : edge_(edge)
  {
    for (const Piece& piece : pieces)
      cells_[cube_of(piece.place, edge)].push_back(piece);
  }
  template <class Visit>
  void near(const Vector& at, Visit&& visit) const
  {
    const auto [i, j, k] = cube_of(at, edge_);
    for (int x = i - 1; x <= i + 1; ++x)
      for (int y = j - 1; y <= j + 1; ++y)
        for (int z = k - 1; z <= k + 1; ++z)
          if (const auto cell = cells_.find({ x, y, z }); cell != cells_.end())
            for (const Piece& piece : cell->second)
              if ((piece.place - at).squaredNorm() < edge_ * edge_)
                visit(piece);
  }

private:
  double edge_;
  std::map<std::array<int, 3>, std::vector<Piece>> cells_;
};

std::vector<double> areas_of(const SkinState& skin, const SkinTriangles& triangles)
{
  std::vector<double> areas(skin.vertices.size(), 0);
  for (const auto& t : triangles)
  {
    const Vector a = to_eigen(skin.vertices[t[0]]);
    const double area = (to_eigen(skin.vertices[t[1]]) - a).cross(to_eigen(skin.vertices[t[2]]) - a).norm() / 6;
    for (const std::int32_t v : t)
      areas[v] += area;
  }
  return areas;
}

// The skin in pieces of about `edge`, so that the cost of a fit does not grow with the fineness of the mesh. Vertices
// in one cube are one piece if their normals have the same main axis and sign: the two sides of a thin sheet, such as a
// lip, stay apart.
std::vector<Piece> pieces_of(const SkinState& skin, const SkinTriangles& triangles, double edge)
{
  const std::vector<double> areas = areas_of(skin, triangles);
  std::map<std::pair<std::array<int, 3>, int>, Piece> sums;
  for (std::size_t v = 0; v < areas.size(); ++v)
  {
    const Vector place = to_eigen(skin.vertices[v]), normal = to_eigen(skin.normals[v]);
    int axis = 0;
    normal.cwiseAbs().maxCoeff(&axis);
    Piece& sum = sums[{ cube_of(place, edge), normal[axis] < 0 ? axis : axis + 3 }];
    sum.place += areas[v] * place;
    sum.normal += areas[v] * normal;
    sum.area += areas[v];
  }
  std::vector<Piece> pieces;
  pieces.reserve(sums.size());
  for (const auto& [where, sum] : sums)
    if (sum.area > 0)
      pieces.push_back({ sum.place / sum.area, sum.normal.normalized(), sum.area });
  return pieces;
}

// Heights of the skin above the skin without folds, whose points are here as well.
struct SmoothSkin
{
  std::vector<double> height;
  std::vector<Vector> foot;
};

// Finds the heights of the corners of the triangles `of`; those of other vertices are 0.
SmoothSkin smooth_skin(const SkinState& skin, const SkinTriangles& triangles, const SkinTriangles& of, double window,
                       const std::function<void(double)>& progress)
{
  const Cells cells(pieces_of(skin, triangles, piece_size * window), reach * window);
  const std::size_t count = skin.vertices.size();
  SmoothSkin out{ std::vector<double>(count, 0), std::vector<Vector>(count, Vector::Zero()) };
  std::vector<bool> used(count, false);
  for (const auto& t : of)
    for (const std::int32_t v : t)
      used[v] = true;
  for (std::size_t i = 0; i < count; ++i)
  {
    if (progress && i % vertices_per_report == 0)
      progress(static_cast<double>(i) / static_cast<double>(skin.vertices.size()));
    if (!used[i])
      continue;
    const Vector at = to_eigen(skin.vertices[i]), own = to_eigen(skin.normals[i]);
    std::vector<std::pair<const Piece*, double>> near;  // pieces near the vertex, and their weights
    Vector normal = Vector::Zero();
    cells.near(at,
               [&](const Piece& piece)
               {
                 // The other side of a thin sheet, such as a lip, does not belong to this skin.
                 if (own.dot(piece.normal) < -0.5)
                   return;
                 near.emplace_back(&piece,
                                   piece.area * std::exp(-0.5 * (piece.place - at).squaredNorm() / (window * window)));
                 normal += near.back().second * piece.normal;
               });
    normal.normalize();
    const Vector a = normal.unitOrthogonal(), b = normal.cross(a);
    Eigen::Matrix<double, 6, 6> matrix = Eigen::Matrix<double, 6, 6>::Identity() * 1e-30;
    Eigen::Matrix<double, 6, 1> right = Eigen::Matrix<double, 6, 1>::Zero();
    for (const auto& [piece, weight] : near)
    {
      const Vector d = (piece->place - at) / window;
      const double x = d.dot(a), y = d.dot(b);
      Eigen::Matrix<double, 6, 1> terms;
      terms << 1, x, y, x * x, x * y, y * y;
      matrix += weight * terms * terms.transpose();
      right += weight * d.dot(normal) * terms;
    }
    const double height = -window * matrix.ldlt().solve(right)[0];
    out.height[i] = height;
    out.foot[i] = at - height * normal;
  }
  return out;
}

// Intersection of a section with an edge of the skin.
struct SectionPoint
{
  double along;  // distance across the furrows, by which points are sorted [m]
  double height;
  Vector place, foot;
  bool inside;  // whether the point is in the box of WrinkleSettings
};

struct Bottom
{
  Vector place, foot;  // [m]
  double depth;        // [m]
};

// Finds the furrows of a section: bottoms beside which the skin rises by at least `least` on both sides before the next
// bottom.
std::vector<Bottom> bottoms_of(std::vector<SectionPoint>& section, double least)
{
  std::sort(section.begin(), section.end(), [](const auto& a, const auto& b) { return a.along < b.along; });
  std::vector<std::size_t> extremes;  // a ridge, a bottom, a ridge, ...
  std::size_t candidate = 0;
  bool ridge = true;  // whether the present candidate is a ridge
  for (std::size_t i = 0; i < section.size(); ++i)
  {
    const double change = section[i].height - section[candidate].height;
    if (ridge ? change > 0 : change < 0)
      candidate = i;
    else if (std::abs(change) > least)
    {
      extremes.push_back(candidate);
      candidate = i;
      ridge = !ridge;
    }
  }
  if (!section.empty())
    extremes.push_back(candidate);
  std::vector<Bottom> bottoms;
  for (std::size_t e = 1; e + 1 < extremes.size(); e += 2)
    if (const SectionPoint& p = section[extremes[e]]; p.inside)
      bottoms.push_back(
          { p.place, p.foot, 0.5 * (section[extremes[e - 1]].height + section[extremes[e + 1]].height) - p.height });
  return bottoms;
}

// Intersections of the skin with planes that are `distance` apart and perpendicular to `direction`, by index of the
// plane.
std::map<int, std::vector<SectionPoint>> sections_of(const SkinState& rest, const SkinState& now,
                                                     const SmoothSkin& smooth, const std::vector<double>& heights,
                                                     const SkinTriangles& triangles, const Vector& direction,
                                                     const Vector& across, const WrinkleSettings& settings)
{
  std::map<int, std::vector<SectionPoint>> sections;
  // Skin that faces away lies behind the skin that is measured, as the lining of the lips does: its points would come
  // between those of the other.
  const Vector outwards = across.cross(direction);
  const auto faces_away = [&](std::size_t v) { return to_eigen(rest.normals[v]).dot(outwards) < -0.3; };
  const auto cross_edge = [&](std::size_t v, std::size_t w)
  {
    if (faces_away(v) && faces_away(w))
      return;
    const double from = to_eigen(now.vertices[v]).dot(direction) / settings.section_distance;
    const double to = to_eigen(now.vertices[w]).dot(direction) / settings.section_distance;
    for (int k = static_cast<int>(std::ceil(std::min(from, to))); k < std::max(from, to); ++k)
    {
      const double share = (k - from) / (to - from);
      const auto between = [share](const Vector& a, const Vector& b) -> Vector { return a + share * (b - a); };
      const Vector at_rest = between(to_eigen(rest.vertices[v]), to_eigen(rest.vertices[w]));
      SectionPoint p{ 0, heights[v] + share * (heights[w] - heights[v]),
                      between(to_eigen(now.vertices[v]), to_eigen(now.vertices[w])),
                      between(smooth.foot[v], smooth.foot[w]), true };
      p.along = p.foot.dot(across);
      for (int axis = 0; axis < 3; ++axis)
        p.inside = p.inside && at_rest[axis] >= settings.lower[axis] && at_rest[axis] <= settings.upper[axis];
      sections[k].push_back(p);
    }
  };
  for (const auto& t : triangles)
    for (std::size_t e = 0; e < 3; ++e)
      if (t[e] < t[(e + 1) % 3])  // the other triangle has the edge in the opposite direction
        cross_edge(t[e], t[(e + 1) % 3]);
  return sections;
}

// The direction in which the heights of the vertices in the box change least, and the direction across it in the skin.
std::array<Vector, 2> directions_of(const SkinState& rest, const SmoothSkin& smooth, const std::vector<double>& heights,
                                    const SkinTriangles& triangles, const WrinkleSettings& settings)
{
  Eigen::Matrix3d changes = Eigen::Matrix3d::Zero();
  Vector normal = Vector::Zero();
  for (const auto& t : triangles)
  {
    const auto outside = [&](std::int32_t v) { return !settings.contains(rest.vertices[v]); };
    if (std::any_of(t.begin(), t.end(), outside))
      continue;
    const Vector a = smooth.foot[t[1]] - smooth.foot[t[0]], b = smooth.foot[t[2]] - smooth.foot[t[0]];
    const Vector area = a.cross(b);
    if (area.squaredNorm() == 0)
      continue;
    const double rise_a = heights[t[1]] - heights[t[0]], rise_b = heights[t[2]] - heights[t[0]];
    const Vector gradient = (rise_a * b.cross(area) + rise_b * area.cross(a)) / area.squaredNorm();
    changes += area.norm() * gradient * gradient.transpose();
    normal += area;
  }
  if (changes.trace() == 0)
    return { Vector::Zero(), Vector::Zero() };
  const Vector across = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(changes).eigenvectors().col(2);
  Vector along = normal.cross(across).normalized();
  int largest = 0;
  along.cwiseAbs().maxCoeff(&largest);
  if (along[largest] < 0)
    along = -along;
  return { along, along.cross(normal).normalized() };
}

// A furrow that is being joined, section by section.
struct OpenFurrow
{
  int section;  // index of the latest section
  Bottom last;
  int bottoms;
  Furrow sum;  // sums over the bottoms
};

void join(std::vector<OpenFurrow>& furrows, int section, const std::vector<Bottom>& bottoms, double farthest)
{
  for (const Bottom& bottom : bottoms)
  {
    OpenFurrow* best = nullptr;
    double nearest = farthest;
    for (OpenFurrow& furrow : furrows)
      if (const double d = (furrow.last.foot - bottom.foot).norm();
          furrow.section < section && furrow.section >= section - 2 && d < nearest)
      {
        nearest = d;
        best = &furrow;
      }
    if (best == nullptr)
      best = &furrows.emplace_back(OpenFurrow{ section, bottom, 0, {} });
    best->sum.length += (best->last.foot - bottom.foot).norm();
    best->sum.depth += bottom.depth;
    for (int axis = 0; axis < 3; ++axis)
      best->sum.middle[axis] += bottom.place[axis];
    best->section = section;
    best->last = bottom;
    ++best->bottoms;
  }
}

double median(std::vector<double> values)
{
  if (values.empty())
    return 0;
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

}  // namespace

std::vector<double> fold_heights(const SkinState& skin, const SkinTriangles& triangles, double window)
{
  return smooth_skin(skin, triangles, triangles, window, {}).height;
}

WrinkleMeter::WrinkleMeter(SkinState rest, SkinTriangles triangles, const WrinkleSettings& settings,
                           const Progress& progress)
    : rest_(std::move(rest)), triangles_(std::move(triangles)), settings_(settings)
{
  // The ridges beside a furrow of the box may lie outside. Skin that faces backwards, such as the lining of the lips,
  // lies behind the skin of the face and would mix with it.
  const double margin = reach * settings.window;
  const auto near = [&](std::int32_t v)
  {
    bool inside = rest_.normals[v][0] > -0.3F;
    for (int axis = 0; axis < 3; ++axis)
      inside = inside && rest_.vertices[v][axis] > settings.lower[axis] - margin &&
               rest_.vertices[v][axis] < settings.upper[axis] + margin;
    return inside;
  };
  for (const auto& t : triangles_)
    if (std::any_of(t.begin(), t.end(), near))
      near_.push_back(t);
  heights_ = smooth_skin(rest_, triangles_, near_, settings.window, progress).height;
}

Wrinkles WrinkleMeter::measure(const SkinState& now, const Progress& progress) const
{
  const SmoothSkin smooth = smooth_skin(now, triangles_, near_, settings_.window, progress);
  std::vector<double> heights(smooth.height);
  for (std::size_t v = 0; v < heights.size(); ++v)
    heights[v] -= heights_[v];
  const auto [direction, across] = directions_of(rest_, smooth, heights, near_, settings_);
  Wrinkles found;
  if (direction.isZero())
    return found;

  std::vector<OpenFurrow> furrows;
  std::vector<double> gaps;
  std::size_t bottoms_found = 0, sections_folded = 0;
  for (auto& [index, section] : sections_of(rest_, now, smooth, heights, near_, direction, across, settings_))
  {
    const std::vector<Bottom> bottoms = bottoms_of(section, settings_.least_depth);
    join(furrows, index, bottoms, 2.5 * settings_.section_distance);
    for (std::size_t b = 0; b < bottoms.size(); ++b)
    {
      found.depth += bottoms[b].depth;
      found.deepest = std::max(found.deepest, bottoms[b].depth);
      if (b > 0)
        gaps.push_back((bottoms[b].foot - bottoms[b - 1].foot).norm());
    }
    bottoms_found += bottoms.size();
    sections_folded += bottoms.empty() ? 0 : 1;
  }
  for (const OpenFurrow& furrow : furrows)
    if (furrow.sum.length >= settings_.least_length)
    {
      Furrow mean = furrow.sum;
      mean.depth /= furrow.bottoms;
      for (double& coordinate : mean.middle)
        coordinate /= furrow.bottoms;
      found.furrows.push_back(mean);
    }
  std::sort(found.furrows.begin(), found.furrows.end(),
            [](const Furrow& a, const Furrow& b) { return a.length > b.length; });
  if (bottoms_found == 0)
    return found;
  found.direction = { direction[0], direction[1], direction[2] };
  found.depth /= static_cast<double>(bottoms_found);
  found.spacing = median(gaps);
  found.count = static_cast<double>(bottoms_found) / static_cast<double>(sections_folded);
  return found;
}

}  // namespace frontalis
