#pragma once

#include "frontalis/physics/closest_point.hpp"

#include <cstdint>

namespace frontalis
{

/// The triangles of a surface nearest to a point, nearest first.
struct NearTriangles
{
  /// Rounds a distance down to float, so that it stays a lower bound and a contact takes a quarter less memory.
  static FRONTALIS_LAW float kept(double distance) { return static_cast<float>(distance * (1 - 1e-7)); }

  static constexpr int capacity = 24;
  static constexpr double reach = 2e-3;  ///< triangles farther than the nearest by more than this are not listed [m]

  physics::Vec3<double> at{ 0, 0, 0 };  ///< the point of the search
  double beyond = -1;                   ///< lower bound of the distance of unlisted triangles [m]
  int count = 0;
  std::int32_t triangle[capacity] = {};  ///< into SurfaceSearch::triangles
  float distance[capacity] = {};         ///< lower bounds [m]
};

/// Exact closest points on a SurfaceTree, with the pseudonormal of the nearest face, edge or corner, which tells the
/// side (Baerentzen & Aanaes 2005). Plain pointers, so that the same search runs on host and GPU.
struct SurfaceSearch
{
  using Point = physics::Vec3<double>;

  struct Box
  {
    float lower[3];
    float upper[3];
    std::int32_t first = 0;  ///< inner node: right child (the left one follows); leaf: first triangle
    std::int32_t count = 0;  ///< triangles of a leaf; 0 for an inner node
  };
  struct Triangle
  {
    Point corner[3];
    Point face_normal;
    Point edge_normal[3];    ///< of edges 01, 12, 20
    Point vertex_normal[3];  ///< weighted by angle
    std::int32_t rim;        ///< bit c: the edge from corner c to the next is on the rim; bit 3 + c: corner c is
    std::int32_t index;      ///< index in the mesh
  };
  struct Closest
  {
    Point point;
    Point normal;  ///< unit pseudonormal at the closest point
    double squared_distance;
    std::int32_t triangle;
    bool rim;  ///< whether it is on the rim of an open surface
  };

  const Box* boxes;
  const Triangle* triangles;
  std::int32_t box_count;

  static FRONTALIS_LAW double squared_distance(const Box& box, const Point& p)
  {
    using N = physics::Number<double>;
    const double x[3] = { p.x, p.y, p.z };
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis)
    {
      const double d = N::max(N::max(box.lower[axis] - x[axis], x[axis] - box.upper[axis]), 0.0);
      sum += d * d;
    }
    return sum;
  }

  /// Completes a closest point with the data of its triangle.
  static FRONTALIS_LAW void describe(const Triangle& triangle, Closest& closest)
  {
    closest.triangle = triangle.index;
    closest.rim = false;
    closest.normal = triangle.face_normal;
    // barycentric coordinates tell whether the point is on the face, an edge or a corner
    const Point& a = triangle.corner[0];
    const Point ab = triangle.corner[1] - a, ac = triangle.corner[2] - a, ap = closest.point - a;
    const double d00 = dot(ab, ab), d01 = dot(ab, ac), d11 = dot(ac, ac), d20 = dot(ap, ab), d21 = dot(ap, ac);
    const double determinant = d00 * d11 - d01 * d01;
    double weight[3];
    weight[1] = (d11 * d20 - d01 * d21) / determinant;
    weight[2] = (d00 * d21 - d01 * d20) / determinant;
    weight[0] = 1 - weight[1] - weight[2];
    constexpr double on_boundary = 1e-7;
    for (int c = 0; c < 3; ++c)
      if (weight[(c + 2) % 3] < on_boundary)
      {
        closest.normal = triangle.edge_normal[c];
        closest.rim = (triangle.rim >> c & 1) != 0;
      }
    for (int c = 0; c < 3; ++c)
      if (weight[c] > 1 - on_boundary)
      {
        closest.normal = triangle.vertex_normal[c];
        closest.rim = (triangle.rim >> (3 + c) & 1) != 0;
      }
  }

  /// Outward unit normal of the offset surface at p, along which the signed distance grows. At the rim of an open
  /// surface distance has no sign of its own and takes that of `kept`; `turned` stores that p has passed around the
  /// rim.
  static FRONTALIS_LAW Point offset_normal(const Closest& closest, const Point& p, double kept, bool& turned)
  {
    const double distance = physics::Number<double>::sqrt(closest.squared_distance);
    if (distance < 1e-7)
      return closest.normal;
    const Point away = p - closest.point;
    bool inside = dot(away, closest.normal) < 0;
    if (closest.rim)
    {
      turned = inside != (kept < 0);
      inside = kept < 0;
    }
    else
      inside = inside != turned;
    return (inside ? -1 / distance : 1 / distance) * away;
  }

  /// Closest point of the surface to p, at most `within` [m] away; triangle -1 if there is none.
  FRONTALIS_LAW Closest closest(const Point& p, double within) const
  {
    Closest best{ { 0, 0, 0 }, { 0, 0, 0 }, within * within, -1, false };
    std::int32_t found = -1;
    std::int32_t stack[64];
    int depth = 0;
    if (box_count > 0)
      stack[depth++] = 0;
    while (depth > 0)
    {
      const std::int32_t self = stack[--depth];
      const Box box = boxes[self];
      if (squared_distance(box, p) > best.squared_distance)
        continue;
      for (std::int32_t t = box.first; t < box.first + box.count; ++t)
      {
        const Triangle& triangle = triangles[t];
        const Point c = physics::closest_point(p, triangle.corner[0], triangle.corner[1], triangle.corner[2]);
        const Point d = p - c;
        const double squared = dot(d, d);
        if (squared < best.squared_distance || (found < 0 && squared <= best.squared_distance))
        {
          best.squared_distance = squared;
          best.point = c;
          found = t;
        }
      }
      if (box.count == 0)
      {
        const std::int32_t left = self + 1, right = box.first;
        const bool left_first = squared_distance(boxes[left], p) < squared_distance(boxes[right], p);
        stack[depth++] = left_first ? right : left;
        stack[depth++] = left_first ? left : right;
      }
    }
    if (found >= 0)
      describe(triangles[found], best);
    return best;
  }

  /// Lists the triangles nearest to p.
  FRONTALIS_LAW void near(const Point& p, NearTriangles& out) const
  {
    out.at = p;
    out.count = 0;
    out.beyond = 1e300;
    std::int32_t stack[64];
    int depth = 0;
    if (box_count > 0)
      stack[depth++] = 0;
    while (depth > 0)
    {
      const std::int32_t self = stack[--depth];
      const Box box = boxes[self];
      if (squared_distance(box, p) > out.beyond * out.beyond)
        continue;
      for (std::int32_t t = box.first; t < box.first + box.count; ++t)
      {
        const Triangle& triangle = triangles[t];
        insert(t, norm(p - physics::closest_point(p, triangle.corner[0], triangle.corner[1], triangle.corner[2])), out);
      }
      if (box.count == 0)
      {
        const std::int32_t left = self + 1, right = box.first;
        const bool left_first = squared_distance(boxes[left], p) <= squared_distance(boxes[right], p);
        stack[depth++] = left_first ? right : left;
        stack[depth++] = left_first ? left : right;
      }
    }
  }

private:
  static FRONTALIS_LAW void insert(std::int32_t triangle, double distance, NearTriangles& out)
  {
    if (!(distance < out.beyond))
      return;
    int place = out.count < NearTriangles::capacity ? out.count++ : NearTriangles::capacity - 1;
    for (; place > 0 && out.distance[place - 1] > distance; --place)
    {
      out.triangle[place] = out.triangle[place - 1];
      out.distance[place] = out.distance[place - 1];
    }
    out.triangle[place] = triangle;
    out.distance[place] = NearTriangles::kept(distance);
    out.beyond = out.distance[0] + NearTriangles::reach;
    if (out.count == NearTriangles::capacity)
      out.beyond = physics::Number<double>::min(out.beyond, out.distance[out.count - 1]);
  }
};

}  // namespace frontalis
