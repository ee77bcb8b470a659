#pragma once

#include "solver/contact/surface_tree.hpp"

namespace frontalis
{

/// Tangent plane of the surface's offset surface, which replaces that surface nearby: normal . p = height.
struct ContactPlane
{
  SurfaceTree::Point normal{ 0, 0, 0 };
  double height = 0;
  double slip = 0;   ///< distance within which the plane's error stays below SurfaceContact::plane_error [m]
  double limit = 0;  ///< distance within which it stays below SurfaceContact::late_error [m], if computed
};

/// A plane is searched for by one thread, or on a GPU by the lanes of a warp together (cuda/kernels/warp_search.cuh).
struct OneThread
{
  static constexpr int size = 1;
  static FRONTALIS_LAW int rank() { return 0; }
  /// The least value in the team. All threads of the team call this and the following functions.
  static FRONTALIS_LAW double least(double x) { return x; }
  /// The value of the first thread with the least key.
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

/// A node's contact with a surface. The node stays on the sheet of the surface that it met first: triangles that face
/// it from the opposite side are ignored, such as the inner table of a thin bone for a node on its outer table. The
/// contact remembers the triangles around the node, so that most closest points need no search. Runs on host and GPU.
class SurfaceContact
{
public:
  using Point = SurfaceTree::Point;

  /// Error of the plane at which a new one is requested [m]: small, because each change of plane excites vibrations.
  static constexpr double plane_error = 0.5e-6;
  /// Largest error of planes that are found beside the steps and may therefore come late [m].
  static constexpr double late_error = 1e-6;
  static constexpr double longest_slip = 0.4e-3;  ///< largest ContactPlane::slip [m]

  SurfaceContact() = default;
  /// `distance`: signed distance to keep [m].
  SurfaceContact(const SurfaceSearch& surface, double distance) : surface_(surface), distance_(distance) {}
  SurfaceContact(const SurfaceTree& tree, double distance) : SurfaceContact(tree.search(), distance) {}

  /// Returns the plane through the closest point to `p`. `Late`: computes its limit too.
  template <bool Late = false, class Team = OneThread>
  FRONTALIS_LAW ContactPlane renew(const Point& p);
  FRONTALIS_LAW void forget()
  {
    near_ = {};
    up_ = { 0, 0, 0 };
    turned_ = false;
  }

  /// Takes over the surface of another contact.
  FRONTALIS_LAW void stay_on(const SurfaceContact& other) { surface_ = other.surface_; }

private:
  using N = physics::Number<double>;
  using Triangle = SurfaceSearch::Triangle;

  static constexpr double apart = 36e-6;  // distances above this keep their sign [m]

  static constexpr double nowhere = 1e300;

  struct Sight
  {
    const SurfaceSearch::Triangle* triangle;
    Point foot;       // closest point of the triangle
    double distance;  // distance to it [m]
  };
  // The listed triangles that are near enough to matter.
  template <class Team>
  struct Surroundings
  {
    int count = 0;
    Sight seen[(NearTriangles::capacity + Team::size - 1) / Team::size];  // by one thread of the team
    Sight closest;       // by the whole team; at infinity if there is none
    double outside = 0;  // lower bound of the distance to all other triangles [m]

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
  Point up_{ 0, 0, 0 };  // unit vector from the latest foot; zero if there is none
  bool turned_ = false;  // has passed around the rim of an open surface
  NearTriangles near_;
};

// Distance from a point of a triangle to its nearest edge.
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
    // another sheet, on the opposite side
    if (seen.distance > apart && dot(p - seen.foot, up_) < -0.5 * seen.distance)
      continue;
    if (seen.distance < s.closest.distance)
      s.closest = seen;
    ++s.count;
  }
  s.closest = Team::of_least(s.closest.distance, s.closest);
  s.outside = Team::least(s.outside);
}

// Within slip of p, on the plane at distance d from the surface, the distance must stay within e of d. There are two
// sufficient conditions, and the larger slip counts. D is the distance of a triangle from p, gap = D - d.
// - By distances, if the point is apart from the surface. A triangle stays farther than d - e if it rises at most e
//   above the tangent plane, if slip is at most gap + e, or if its linearised distance does, since distance is convex.
//   Some of the surface is within d + e: the triangle of the foot, and a circle beyond its edge.
// - By the gradient, which is a mean of the normals of the faces around the foot. Normals within e / slip of the
//   plane's normal are harmless, and so are faces that no foot reaches. A foot is within d + e, so its face has
//   gap - e <= slip; its lateral distance is at most slip + r, with r^2 = (d + e)^2 - (d - rise)^2. At a rim the
//   gradient is unrestricted.
template <class Team>
FRONTALIS_LAW double SurfaceContact::slip(const Point& p, const Surroundings<Team>& s, const Point& normal,
                                          double error, double e) const
{
  const Point& foot = s.closest.foot;
  const double d = s.closest.distance;
  // normal towards the node
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
  // Searches again if another triangle might be closer, or if the list covers too small a range to allow any slip.
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
  // a surface without triangles restricts nothing
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
