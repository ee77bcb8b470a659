#include "bake/voxels/tissue_sheet.hpp"

#include "bake/mesh/cluster_search.hpp"
#include "bake/bake_monitor.hpp"
#include "bake/voxels/voxel_index.hpp"
#include "frontalis/model/sample_field.hpp"

#include <Eigen/Dense>
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <queue>
#include <set>

namespace frontalis
{
namespace
{

Vector3d normal_of(const std::array<Vector3d, 3>& v) { return (v[1] - v[0]).cross(v[2] - v[0]).normalized(); }

/// Whether `ask` is true at any point of a triangle; tries points at most `spacing` [m] apart.
template <class Ask>
bool any_point(const std::array<Vector3d, 3>& v, double spacing, const Ask& ask)
{
  const double longest = std::max({ (v[1] - v[0]).norm(), (v[2] - v[1]).norm(), (v[0] - v[2]).norm() });
  const int parts = std::clamp(static_cast<int>(std::ceil(longest / spacing)), 1, 1000);
  for (int i = 0; i < parts; ++i)
    for (int j = 0; i + j < parts; ++j)
    {
      const double a = (i + 1.0 / 3) / parts, b = (j + 1.0 / 3) / parts;
      if (ask(v[0] + a * (v[1] - v[0]) + b * (v[2] - v[0])))
        return true;
    }
  return false;
}

/// Extends a selection of triangles across their edges by up to usual_travel, as long as normals differ by at most 78
/// degrees from that of the selected triangle where the path began. The selection thus goes round the rim of a bone,
/// but not behind the bone. Enters only triangles for which enters(triangle) is true.
template <class Enters>
void grow(const TriangleMesh& mesh, std::vector<bool>& selected, const Enters& enters)
{
  constexpr double least_cosine = 0.2;
  std::map<std::pair<std::int32_t, std::int32_t>, std::vector<std::size_t>> at_edge;
  std::vector<Vector3d> normal;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
  {
    normal.push_back(normal_of(corners(mesh, mesh.triangles[t])));
    for (std::size_t c = 0; c < 3; ++c)
      at_edge[std::minmax(mesh.triangles[t][c], mesh.triangles[t][(c + 1) % 3])].push_back(t);
  }
  // Dijkstra's algorithm over the middles of edges, through which triangles are entered
  struct Entry
  {
    double way;
    std::size_t triangle;
    Vector3d at, normal;  ///< middle of the edge of entry; normal of the triangle where the path began
    bool operator<(const Entry& other) const { return way > other.way; }
  };
  std::priority_queue<Entry> entries;
  const auto leave = [&](std::size_t t, double way, const Vector3d* at, const Vector3d& origin)
  {
    for (std::size_t c = 0; c < 3; ++c)
    {
      const std::int32_t a = mesh.triangles[t][c], b = mesh.triangles[t][(c + 1) % 3];
      const Vector3d middle = 0.5 * (vertex(mesh, a) + vertex(mesh, b));
      const double far = way + (at == nullptr ? 0 : (middle - *at).norm());
      for (const std::size_t other : at_edge.at(std::minmax(a, b)))
        if (!selected[other] && far < usual_travel && normal[other].dot(origin) >= least_cosine)
          entries.push({ far, other, middle, origin });
    }
  };
  const std::vector<bool> seeds = selected;
  for (std::size_t t = 0; t < seeds.size(); ++t)
    if (seeds[t])
      leave(t, 0, nullptr, normal[t]);
  while (!entries.empty())
  {
    const Entry entry = entries.top();
    entries.pop();
    if (selected[entry.triangle] || !enters(entry.triangle))
      continue;
    selected[entry.triangle] = true;
    leave(entry.triangle, entry.way, &entry.at, entry.normal);
  }
}

/// Centre and radius of the sphere that a closed mesh approximates. All vertices must lie on the sphere within a
/// thousandth of its radius, and middles of triangles within a hundredth; otherwise the result is empty.
std::optional<std::pair<Vector3d, double>> sphere_of(const PreparedSurface& surface)
{
  const TriangleMesh& mesh = surface.mesh();
  if (!surface.closed() || mesh.vertices.size() < 12)
    return std::nullopt;
  // for a sphere with centre c and any point m, |v - m|^2 = 2 (c - m) . (v - m) + k with the same k at all vertices v
  const Vector3d middle = surface.box().center();
  Eigen::MatrixX4d a(mesh.vertices.size(), 4);
  Eigen::VectorXd b(mesh.vertices.size());
  for (std::size_t n = 0; n < mesh.vertices.size(); ++n)
  {
    const Vector3d v = vertex(mesh, static_cast<std::int32_t>(n)) - middle;
    a.row(static_cast<Eigen::Index>(n)) << 2 * v.transpose(), 1;
    b[static_cast<Eigen::Index>(n)] = v.squaredNorm();
  }
  const Eigen::Vector4d fit = a.colPivHouseholderQr().solve(b);
  const Vector3d centre = middle + fit.head<3>();
  const double radius = std::sqrt(fit[3] + fit.head<3>().squaredNorm());
  const auto near = [&](const Vector3d& p, double tolerance)
  { return std::abs((p - centre).norm() - radius) <= tolerance * radius; };
  for (const Triangle& t : mesh.triangles)
  {
    const auto v = corners(mesh, t);
    if (!near(v[0], 1e-3) || !near(v[1], 1e-3) || !near(v[2], 1e-3) || !near((v[0] + v[1] + v[2]) / 3, 1e-2))
      return std::nullopt;
  }
  return std::pair(centre, radius);
}

/// For each triangle and each ClosestPoint::feature, whether that part of the triangle lies on the rim of the mesh.
std::vector<std::array<bool, 7>> rim_features(const TriangleMesh& mesh)
{
  std::set<std::pair<std::int32_t, std::int32_t>> edges;
  std::vector<bool> corners(mesh.vertices.size(), false);
  for (const auto& [a, b] : unbalanced_edges(mesh))
  {
    edges.insert(std::minmax(a, b));
    corners[a] = corners[b] = true;
  }
  std::vector<std::array<bool, 7>> features(mesh.triangles.size());
  for (std::size_t t = 0; t < features.size(); ++t)
    for (std::size_t c = 0; c < 3; ++c)
    {
      const std::int32_t a = mesh.triangles[t][c], b = mesh.triangles[t][(c + 1) % 3];
      features[t][1 + c] = edges.count(std::minmax(a, b)) > 0;
      features[t][4 + c] = corners[a];
    }
  return features;
}

/// Whether a triangle faces one of the other surfaces within `gap` [m], or overlaps it by less than `gap`.
bool faces(const std::vector<const PreparedSurface*>& others, const std::array<Vector3d, 3>& triangle, double gap)
{
  const Vector3d middle = (triangle[0] + triangle[1] + triangle[2]) / 3, normal = normal_of(triangle);
  return std::any_of(others.begin(), others.end(),
                     [&](const PreparedSurface* other)
                     {
                       const ClosestPoint closest = other->tree().closest(middle, gap);
                       return closest.triangle >= 0 && other->pseudonormal(closest).dot(normal) < 0;
                     });
}

/// Returns for each triangle of a surface its number in the surface's sheet, which has the triangles in the same order,
/// or -1 if it is not in the sheet.
std::vector<std::int32_t> numbers_in_sheet(const SlidingSurface& surface)
{
  const TriangleMesh &whole = surface.whole->mesh(), &sheet = surface.sheet->mesh();
  std::vector<std::int32_t> number(whole.triangles.size(), -1);
  std::int32_t next = 0;
  for (std::size_t t = 0; t < number.size() && next < static_cast<std::int32_t>(sheet.triangles.size()); ++t)
    if (corners(whole, whole.triangles[t]) == corners(sheet, sheet.triangles[next]))
      number[t] = next++;
  return number;
}

/// Distance of points from one sheet of a field.
class SheetDistance
{
public:
  explicit SheetDistance(const SlidingSurface& of)
      : of_(of), on_rim_(rim_features(of.sheet->mesh())), number_(numbers_in_sheet(of))
  {
  }

  /// Searches of one thread, for points that lie close together; `extent`: see ClusterSearch.
  struct Searches
  {
    ClusterSearch sheet, whole;
  };
  Searches searches(double extent) const { return { { of_.sheet->tree(), extent }, { of_.whole->tree(), extent } }; }

  struct Closest
  {
    ClosestPoint sheet;  ///< the closest point of the sheet
    ClosestPoint whole;  ///< that of the whole surface, if it is closed
  };
  Closest closest(const Vector3d& p, double bound, Searches& searches) const
  {
    if (!of_.whole->closed())
      return { searches.sheet.closest(p, bound), {} };
    const ClosestPoint whole = searches.whole.closest(p, bound);
    ClosestPoint sheet = whole;
    if (whole.triangle >= 0)
      sheet.triangle = number_[whole.triangle];
    // The sheet is searched alone only if the closest point of the whole surface is not on it.
    return { whole.triangle < 0 || sheet.triangle >= 0 ? sheet : searches.sheet.closest(p, bound), whole };
  }

  const Vector3d& normal(const Closest& closest) const { return of_.sheet->pseudonormal(closest.sheet); }

  SurfaceDistance at(const Vector3d& p, const Closest& closest) const
  {
    const Vector3d away = p - closest.sheet.point;
    const double height = away.dot(normal(closest));
    // A point inside a closed surface counts as below its sheet, also if another part of the surface is closer.
    if (height > 0 && of_.whole->closed() && of_.whole->signed_distance(p, closest.whole) < 0)
      return -closest.sheet.distance;
    if (on_rim_[closest.sheet.triangle][closest.sheet.feature])
      return { height, (away - height * normal(closest)).norm() };
    return std::copysign(closest.sheet.distance, height);
  }

private:
  SlidingSurface of_;
  std::vector<std::array<bool, 7>> on_rim_;
  std::vector<std::int32_t> number_;  ///< see numbers_in_sheet()
};

/// Distance from several sheets: a mean of the nearest one and of others that are at most 1 mm farther. The others have
/// more weight the nearer they are, and the more nearly parallel to the nearest one. A node can thus pass from one bone
/// to the next across a gap between their sheets, and sheets that face each other stay separate.
SurfaceDistance distance_from(const std::vector<SheetDistance>& sheets, std::vector<SheetDistance::Searches>& searches,
                              const Vector3d& p)
{
  constexpr double hardly_farther = 1e-3, widest_gap = 5e-3;  // [m]
  std::vector<SheetDistance::Closest> closest;
  closest.reserve(sheets.size());
  std::size_t nearest = 0;
  const auto distance = [&closest](std::size_t s) { return closest[s].sheet.distance; };
  for (std::size_t s = 0; s < sheets.size(); ++s)
  {
    closest.push_back(sheets[s].closest(p, s == 0 ? 1e300 : distance(nearest) + widest_gap, searches[s]));
    if (closest[s].sheet.triangle >= 0 && distance(s) < distance(nearest))
      nearest = s;
  }
  const Vector3d& normal = sheets[nearest].normal(closest[nearest]);
  SurfaceDistance sum = sheets[nearest].at(p, closest[nearest]);
  double weights = 1;
  for (std::size_t s = 0; s < sheets.size(); ++s)
  {
    if (s == nearest || closest[s].sheet.triangle < 0)
      continue;
    const double alike = std::max(0.0, normal.dot(sheets[s].normal(closest[s])));
    const double farther = (distance(s) - distance(nearest)) / hardly_farther;
    // a point between two sheets is not past their rims
    if (alike > 0)
      sum.past_rim = 0;
    if (farther >= 1)
      continue;
    const double weight = std::pow((1 - farther) * alike, 2);
    sum.value += weight * sheets[s].at(p, closest[s]).value;
    weights += weight;
  }
  sum.value /= weights;
  return sum;
}

}  // namespace

double tissue_side(const PreparedSurface& surface, const LocalFrame& frame, const Model& model)
{
  constexpr std::size_t grain = 4096;
  const double edge = to_vector(model.spacing).maxCoeff();
  // amount of tissue near the surface, and the amount on the outer side minus that on the inner side
  using Sums = std::array<double, 2>;
  const auto add_range = [&](const tbb::blocked_range<std::size_t>& range, Sums sums)
  {
    for (std::size_t e = range.begin(); e < range.end(); ++e)
    {
      const Vector3d p = frame.voxel_centre(model, e);
      if (surface.box().squaredExteriorDistance(p) > 4 * edge * edge)
        continue;
      const ClosestPoint closest = surface.tree().closest(p, 2 * edge);
      if (closest.triangle < 0)
        continue;
      const auto fill = static_cast<double>(model.fill[e]);
      sums[0] += fill;
      sums[1] += surface.signed_distance(p, closest) > 0 ? fill : -fill;
    }
    return sums;
  };
  const auto [all, surplus] = tbb::parallel_deterministic_reduce(
      tbb::blocked_range<std::size_t>(0, model.voxels.size(), grain), Sums{}, add_range,
      [](const Sums& a, const Sums& b) {
        return Sums{ a[0] + b[0], a[1] + b[1] };
      });
  return std::abs(surplus) < 0.4 * all || all == 0 ? 0 : (surplus > 0 ? 1 : -1);
}

bool is_sphere(const PreparedSurface& surface) { return sphere_of(surface).has_value(); }

TriangleMesh tissue_sheet(const PreparedSurface& surface, double side, const std::vector<const PreparedSurface*>& bones,
                          const LocalFrame& frame, const Model& model)
{
  const TriangleMesh& mesh = surface.mesh();
  if (sphere_of(surface))
    return mesh;
  const VoxelIndex tissue(model);
  const Vector3d spacing = to_vector(model.spacing);
  // an almost empty voxel may lie mostly in the bone on the other side of a suture
  constexpr double least_fill = 0.2;
  const auto is_tissue = [&](const Vector3d& p)
  {
    const Vector3d cell = frame.to_local(p).cwiseQuotient(spacing).array().floor();
    if (cell.cwiseAbs().maxCoeff() > 1e6)
      return false;
    const std::int32_t e = tissue.find({ { static_cast<std::int32_t>(cell[0]), static_cast<std::int32_t>(cell[1]),
                                           static_cast<std::int32_t>(cell[2]) } });
    return e >= 0 && double(model.fill[e]) >= least_fill;
  };
  std::vector<bool> facing(mesh.triangles.size(), false);
  const auto is_wall = [&](std::size_t t)
  { return faces(bones, corners(mesh, mesh.triangles[t]), spacing.maxCoeff()); };
  for (std::size_t t = 0; t < facing.size(); ++t)
  {
    if (is_wall(t))
      continue;
    const auto v = corners(mesh, mesh.triangles[t]);
    const Vector3d ahead = spacing.maxCoeff() * normal_of(v);
    facing[t] = any_point(v, spacing.minCoeff(),
                          [&](const Vector3d& p)
                          { return (side >= 0 && is_tissue(p + ahead)) || (side <= 0 && is_tissue(p - ahead)); });
  }
  // If no triangle faces tissue, because the tissue is thinner than a voxel, the whole surface is kept.
  if (std::find(facing.begin(), facing.end(), true) == facing.end())
    return mesh;
  grow(mesh, facing, [&](std::size_t t) { return !is_wall(t); });
  return keep_triangles(mesh, facing);
}

SampledField distance_field(const std::vector<SlidingSurface>& surfaces, const std::vector<std::array<double, 3>>& rest,
                            const LocalFrame& frame, const Model& model, BakeMonitor& monitor)
{
  if (const auto sphere = sphere_of(*surfaces.front().whole))
    return sphere_field(to_array(frame.to_local(sphere->first)), sphere->second);
  const std::vector<SheetDistance> sheets(surfaces.begin(), surfaces.end());
  const double spacing = std::min(0.5e-3, 0.5 * to_vector(model.spacing).minCoeff());
  std::vector<SheetDistance::Searches> searches;
  searches.reserve(sheets.size());
  for (const SheetDistance& sheet : sheets)
    searches.push_back(sheet.searches(cluster_extent * spacing));
  tbb::enumerable_thread_specific<std::vector<SheetDistance::Searches>> of_thread(searches);
  const auto distance = [&](const std::array<double, 3>& local)
  { return distance_from(sheets, of_thread.local(), frame.to_scene(to_vector(local))); };
  constexpr std::size_t grain = 16;
  return sample_field(rest, distance, spacing, usual_travel,
                      [&](std::size_t count, const std::function<void(std::size_t)>& body)
                      { parallel_for(monitor, count, grain, body); });
}

}  // namespace frontalis
