#pragma once

#include "frontalis/physics/surface_foot.hpp"

#include <cstdint>

namespace frontalis
{

/// The search for triangles that a vertex may touch, for all backends. Its functions are templated on a view of the
/// surfaces, which has
///   Number                    the number type
///   edge_error                tolerance in barycentric coordinates: a foot (physics::SurfaceFoot) that is beyond an
///                             edge by less than this stays in its triangle
///   apart(v, w)               vector from vertex w to vertex v [m]
///   rest_apart(v, w)          the same at rest
///   normal(v), overlap(v)     the vertex's normal, and its gap at rest [m]
///   contact_of(v)             index of its surface among Model::self_contacts
///   joined(v, w)              whether two vertices never touch, because they are close along the surface
///   corners(t)                TouchingSurface::Triangle::vertex
///   neighbours(t)             TouchingSurface::Triangle::neighbour
///   triangle(t)               triangle_of(); follow() calls it before it asks for anything else of t
///   placed(t)                 whether the present positions of the corners are known
///   edge()                    shortest voxel edge [m]
namespace touch_search
{

// Lengths are in units of the shortest voxel edge.
/// A vertex and a triangle form a pair if the vertex is at most `reach` in front of the triangle or at most
/// `deepest_held` behind it.
constexpr double reach = 0.5, deepest_held = 1;
/// Depth behind a triangle up to which the search finds a vertex. A vertex moves less than that between two searches.
constexpr double deepest_found = 0.5;
/// A point that is behind a triangle at rest may touch it if its depth is at most `overlap_at_rest`; at larger depths,
/// up to `thickest_sheet`, it belongs to the other side of the same sheet of tissue.
constexpr double overlap_at_rest = 0.25, thickest_sheet = 3;

/// The other side of a sheet lies within an angle with this cosine from a triangle's inward normal.
constexpr double across_sheet = 0.5;
/// Fraction of the reach by which a vertex and a triangle may approach each other before a CPU repeats the search. It
/// does so as soon as they could have approached each other by most of this (TissueContact).
constexpr double renewal_share = 0.8;
/// Factor on the reach that allows for motion between the sorting of triangles and the search.
constexpr double margin = 1.1;
/// Tolerance in barycentric coordinates. It is above the error of a foot, so that no foot falls between two triangles.
constexpr double foot_error = 0.02;
/// A vertex and a triangle do not face each other if the cosine between their normals exceeds this value.
constexpr double same_way = 0.5;
/// Largest number of triangles that a vertex crosses in a step.
constexpr int most_hops = 16;
/// Largest number of triangles that a vertex forms pairs with.
constexpr int most_pairs = 2;

/// Hash of a cell of the grid of triangles. The factors are primes of Teschner et al., Optimized spatial hashing for
/// collision detection of deformable objects, VMV 2003.
FRONTALIS_LAW std::uint32_t cell_hash(std::int64_t x, std::int64_t y, std::int64_t z)
{
  return static_cast<std::uint32_t>(x) * 73856093U ^ static_cast<std::uint32_t>(y) * 19349663U ^
         static_cast<std::uint32_t>(z) * 83492791U;
}

/// A triangle with positions relative to its corner 0, so that differences of positions are exact in single precision.
template <class View, class T = typename View::Number>
FRONTALIS_LAW physics::SurfaceTriangle<T> triangle_of(const View& view, std::int32_t t)
{
  const std::int32_t* const corner = view.corners(t);
  return { { { T(0), T(0), T(0) }, view.apart(corner[1], corner[0]), view.apart(corner[2], corner[0]) },
           { view.normal(corner[0]), view.normal(corner[1]), view.normal(corner[2]) } };
}

/// Changes t, a triangle near the vertex p, to the triangle of the surface under p, and returns p's foot there. Does
/// not enter triangles whose corners have no present positions. `triangle`: set to triangle_of(t).
template <class View, class T>
FRONTALIS_LAW physics::SurfaceFoot<T> follow(View&& view, std::int32_t p, std::int32_t& t,
                                             physics::SurfaceTriangle<T>& triangle)
{
  for (std::int32_t hop = 0, from = -1;; ++hop)
  {
    triangle = view.triangle(t);
    const physics::SurfaceFoot<T> foot = physics::surface_foot(triangle, view.apart(p, view.corners(t)[0]));
    const std::int32_t* const neighbour = view.neighbours(t);
    std::int32_t to = -1;
    T least = static_cast<T>(-view.edge_error);
    FRONTALIS_UNROLL
    for (int i = 0; i < 3; ++i)
      if (hop < most_hops && neighbour[i] >= 0 && foot.weight[i] < least && view.placed(neighbour[i]))
      {
        least = foot.weight[i];
        to = neighbour[i];
      }
    // A foot may be beyond the common edge of two triangles on both sides. The vertex would hop to and fro; it takes
    // the triangle where that would end.
    if (to < 0 || (to == from && (most_hops - hop) % 2 == 0))
      return foot;
    from = t;
    t = to;
  }
}

/// Whether two triangles have a corner in common.
template <class View>
FRONTALIS_LAW bool adjoin(const View& view, std::int32_t t, std::int32_t s)
{
  const std::int32_t *const a = view.corners(t), *const b = view.corners(s);
  bool any = false;
  for (int i = 0; i < 3; ++i)
    any = any || a[i] == b[0] || a[i] == b[1] || a[i] == b[2];
  return any;
}

/// Whether a vertex and a triangle never touch, because their distance along the surface is small, or because they are
/// on the two sides of one sheet of tissue.
template <class View, class T = typename View::Number>
FRONTALIS_LAW bool inseparable(const View& view, std::int32_t p, std::int32_t t)
{
  const std::int32_t* const corner = view.corners(t);
  if (view.joined(p, corner[0]) || view.joined(p, corner[1]) || view.joined(p, corner[2]))
    return true;
  const physics::Vec3<T> b = view.rest_apart(corner[1], corner[0]), c = view.rest_apart(corner[2], corner[0]);
  const physics::Vec3<T> normal = cross(b, c), way = view.rest_apart(p, corner[0]) - T(1.0 / 3) * (b + c);
  const T length = norm(way), deep = T(overlap_at_rest) * view.edge(), aside = T(across_sheet) * length;
  return length < T(thickest_sheet) * view.edge() && dot(way, normal) < -(deep > aside ? deep : aside) * norm(normal);
}

/// Whether a triangle of a facing surface is in front of a vertex within a distance, or just behind it. `within`: that
/// distance [m]; `cell`: edge of the grid's cells [m]; `gap`: set to the vertex's gap less its overlap [m].
template <class View, class T = typename View::Number>
FRONTALIS_LAW bool may_touch(const View& view, std::int32_t p, std::int32_t t, T within, T cell, T& gap)
{
  const std::int32_t* const corner = view.corners(t);
  const physics::Vec3<T> way = view.apart(p, corner[0]), inward = view.normal(p);
  const T farthest = 2 * cell - T(margin) * within;
  if (dot(way, way) > farthest * farthest || dot(inward, view.normal(corner[0])) > T(same_way) ||
      view.contact_of(p) != view.contact_of(corner[0]))
    return false;
  const physics::SurfaceFoot<T> foot = physics::surface_foot(triangle_of(view, t), way);
  gap = foot.gap - view.overlap(p);
  if (gap > within || gap < T(-deepest_found) * view.edge() || dot(foot.normal, inward) > 0)
    return false;
  const std::int32_t* const neighbour = view.neighbours(t);
  for (int i = 0; i < 3; ++i)
    if (foot.weight[i] < -(neighbour[i] < 0 ? within * norm(foot.slope[i]) : T(foot_error)))
      return false;
  return !inseparable(view, p, t);
}

}  // namespace touch_search
}  // namespace frontalis
