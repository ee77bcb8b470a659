#pragma once

#include "solver/contact/surface_tree.hpp"

namespace frontalis
{

/// Tangent plane of the surface's offset surface, which stands for it nearby: normal . p = height.
struct ContactPlane
{
  SurfaceTree::Point normal{ 0, 0, 0 };
  double height = 0;
  double slip = 0;   ///< how far a point may move before the plane errs by more than SurfaceContact::plane_error [m]
  double limit = 0;  ///< or, where it is known, by more than SurfaceContact::late_error [m]
};

/// Who looks for a plane: one thread. On a GPU the lanes of a warp do it together (cuda/warp_search.cuh).
struct OneThread
{
  static constexpr int size = 1;
  static FRONTALIS_LAW int rank() { return 0; }
  /// Over the team; all of it calls this and the others.
  static FRONTALIS_LAW double least(double x) { return x; }
  /// What the first of those has whose key is least.
  template <class T>
  static FRONTALIS_LAW const T& of_least(double, const T& value)
  {
    return value;
  }
  static FRONTALIS_LAW void near(const SurfaceSearch& surface, const SurfaceSearch::Point& p, NearTriangles& out)
  {
    surface.near(p, out);
  }
};

/// One node on a surface, on the sheet of it that it met first: walls that face it from across are left alone, such as
/// the inner table of a thin bone for a node in its outer one. Knows the triangles around it, so that most of its exact
/// closest points need no search. Runs on host and GPU.
class SurfaceContact
{
public:
  using Point = SurfaceTree::Point;

  /// Error of the plane from which another is wanted [m]. It sets off vibrations, each time: with 9e-6, a motion with a
  /// time step that is 1 % shorter ended four times farther away.
  static constexpr double plane_error = 0.5e-6;
  /// Its largest error where planes are found beside the steps, and may come late [m].
  static constexpr double late_error = 1e-6;
  static constexpr double longest_slip = 0.4e-3;  ///< [m]

  SurfaceContact() = default;
  /// `distance` is the one to keep [m], signed.
  SurfaceContact(const SurfaceSearch& surface, double distance) : surface_(surface), distance_(distance) {}
  SurfaceContact(const SurfaceTree& tree, double distance) : SurfaceContact(tree.search(), distance) {}

  /// Plane through the exact closest point to p; with its limit, where it may be renewed late.
  template <bool Late = false, class Team = OneThread>
  FRONTALIS_LAW ContactPlane renew(const Point& p);
  FRONTALIS_LAW void forget()
  {
    near_ = {};
    up_ = { 0, 0, 0 };
    turned_ = false;
  }

  /// Takes the other's surface.
  FRONTALIS_LAW void stay_on(const SurfaceContact& other) { surface_ = other.surface_; }

private:
  using N = physics::Number<double>;
  using Triangle = SurfaceSearch::Triangle;

  static constexpr double apart = 36e-6;  // from here on a distance keeps its sign

  static constexpr double nowhere = 1e300;

  struct Sight
  {
    const SurfaceSearch::Triangle* triangle;
    Point foot;       // its closest point
    double distance;  // to that [m]
  };
  // the triangles listed, as far as they matter
  template <class Team>
  struct Surroundings
  {
    int count = 0;
    Sight seen[(NearTriangles::capacity + Team::size - 1) / Team::size];  // by one of the team
    Sight closest;                                                        // by the whole team; nowhere: none
    double outside = 0;  // all triangles that nobody saw are at least so far [m]

    FRONTALIS_LAW bool empty() const { return closest.distance >= nowhere; }
  };

  static FRONTALIS_LAW double size(double x) { return N::max(x, -x); }
  static FRONTALIS_LAW double to_boundary(const Triangle& triangle, const Point& at);
  template <class Team>
  FRONTALIS_LAW void look(const Point& p, Surroundings<Team>& s) const;
  template <class Team>
  FRONTALIS_LAW double slip(const Point& p, const Surroundings<Team>& s, const Point& normal, double error,
                            double e) const;

  SurfaceSearch surface_{ nullptr, nullptr, 0 };
  double distance_ = 0;
  Point up_{ 0, 0, 0 };  // unit vector from the latest foot; zero: there is none
  bool turned_ = false;  // has gone round the rim of an open surface
  NearTriangles near_;
};

// from a point of a triangle to the nearest of its edges
FRONTALIS_LAW double SurfaceContact::to_boundary(const Triangle& triangle, const Point& at)
{
  double shortest = 1e300;
  for (int c = 0; c < 3; ++c)
  {
    const Point edge = triangle.corner[(c + 1) % 3] - triangle.corner[c];
    const Point inwards = cross(triangle.face_normal, edge);
    shortest = N::min(shortest, dot(at - triangle.corner[c], inwards) / norm(edge));
  }
  return N::max(shortest, 0.0);
}

template <class Team>
FRONTALIS_LAW void SurfaceContact::look(const Point& p, Surroundings<Team>& s) const
{
  const double moved = norm(p - near_.at);
  s.count = 0;
  s.closest = { nullptr, { 0, 0, 0 }, nowhere };
  s.outside = near_.beyond - moved;
  for (int k = Team::rank(); k < near_.count; k += Team::size)
  {
    if (near_.distance[k] - moved > s.closest.distance + longest_slip + 2 * late_error)
    {
      s.outside = N::min(s.outside, near_.distance[k] - moved);
      break;
    }
    Sight& seen = s.seen[s.count];
    seen.triangle = &surface_.triangles[near_.triangle[k]];
    const auto& corner = seen.triangle->corner;
    seen.foot = closest_point(p, corner[0], corner[1], corner[2]);
    seen.distance = norm(p - seen.foot);
    // another sheet, across from this one
    if (seen.distance > apart && dot(p - seen.foot, up_) < -0.5 * seen.distance)
      continue;
    if (seen.distance < s.closest.distance)
      s.closest = seen;
    ++s.count;
  }
  s.closest = Team::of_least(s.closest.distance, s.closest);
  s.outside = Team::least(s.outside);
}

// Within slip of p, on the plane at height d over the tangent plane at p's foot, distance must stay within e of d. Two
// arguments, each of which holds by itself; the larger slip counts. D is how far a triangle is from p, gap = D - d.
// - By distances, for a point apart from the surface. A triangle comes no nearer than d - e if it rises no more than e
//   above the tangent plane; if slip is at most gap + e; and, distance to it being convex, if its linearisation does
//   not. And some of the surface is within d + e: the foot's own triangle, and a circle beyond its edge.
// - By the gradient, which is a mean of the normals of the faces around the foot: those within e / slip of the plane's
//   normal do no harm, nor do faces that no foot reaches. A foot is within d + e, so its face has gap - e <= slip; and
//   sideways it is within slip + r, where r^2 = (d + e)^2 - (d - rise)^2. At a rim the gradient is free.
template <class Team>
FRONTALIS_LAW double SurfaceContact::slip(const Point& p, const Surroundings<Team>& s, const Point& normal,
                                          double error, double e) const
{
  const Point& foot = s.closest.foot;
  const double d = s.closest.distance;
  // towards the node
  const Point up = dot(p - foot, normal) < 0 ? -1.0 * normal : normal;
  const double gap_outside = s.outside - d - 2 * error;
  double by_gradient = gap_outside - e, by_distance = 0;
  if (d > apart)
    by_distance = N::min(gap_outside + e, to_boundary(*s.closest.triangle, foot) + N::sqrt(e * (e + 2 * d)));
  for (int k = 0; k < s.count; ++k)
  {
    const Sight& seen = s.seen[k];
    const Triangle& t = *seen.triangle;
    const Point direction = (1 / N::max(seen.distance, 1e-12)) * (p - seen.foot) - up;
    const double squared_turn = dot(direction, direction);
    const double gap = seen.distance - d - 0.5 * squared_turn * error;
    const double rise =
        N::max(N::max(dot(t.corner[0] - foot, up), dot(t.corner[1] - foot, up)), dot(t.corner[2] - foot, up));
    if (d > apart && rise > e && by_distance > gap + e &&
        by_distance * by_distance * squared_turn > (gap + e) * (gap + e))
      by_distance = N::max(gap + e, (gap + e) / N::sqrt(squared_turn));
    if (by_gradient <= gap - e)
      continue;
    const double turn = t.rim != 0 ? 2.0 : norm(t.face_normal - normal);
    if (turn * by_gradient <= e)
      continue;
    const double low = N::max(d - N::max(rise, e), 0.0), far = seen.distance - error;
    const double sideways = N::sqrt(N::max(far * far - (d + e) * (d + e), 0.0));
    const double reach = sideways - N::sqrt((d + e) * (d + e) - low * low);
    by_gradient = N::min(by_gradient, N::max(N::max(gap - e, reach), e / turn));
  }
  by_distance = Team::least(by_distance);
  by_gradient = Team::least(by_gradient);
  return N::min(N::max(0.999 * N::max(by_distance, by_gradient), 0.0), longest_slip);
}

template <bool Late, class Team>
FRONTALIS_LAW ContactPlane SurfaceContact::renew(const Point& p)
{
  const bool first = dot(up_, up_) == 0;
  Surroundings<Team> s;
  look(p, s);
  // anew where another might be closer, and where so little is left of the list that it allows no slip
  if (s.empty() || s.outside - s.closest.distance < 0.2 * (near_.beyond - near_.distance[0]))
  {
    Team::near(surface_, p, near_);
    look(p, s);
  }
  if (s.empty() && !first)
  {
    up_ = { 0, 0, 0 };
    look(p, s);
  }
  // a surface without triangles holds nothing
  if (s.empty())
    return {};
  SurfaceSearch::Closest closest{};
  closest.point = s.closest.foot;
  closest.squared_distance = s.closest.distance * s.closest.distance;
  SurfaceSearch::describe(*s.closest.triangle, closest);
  const Point normal = SurfaceSearch::offset_normal(closest, p, distance_, turned_);
  up_ = dot(p - closest.point, normal) < 0 ? -1.0 * normal : normal;
  if (first)
    look(p, s);
  const double error = size(dot(normal, p - closest.point) - distance_);
  ContactPlane plane{ normal, dot(normal, closest.point) + distance_, slip(p, s, normal, error, plane_error), 0 };
  if constexpr (Late)
    plane.limit = N::max(plane.slip, slip(p, s, normal, error, late_error));
  return plane;
}

}  // namespace frontalis
