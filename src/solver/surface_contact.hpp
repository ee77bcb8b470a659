#pragma once

#include "surface_tree.hpp"

namespace frontalis
{

/// Tangent plane of the surface's offset surface, which stands for it nearby: normal . p = height.
struct ContactPlane
{
  SurfaceTree::Point normal{ 0, 0, 0 };
  double height = 0;
  double slip = 0;  ///< how far a point may move before the plane errs by more than SurfaceContact::plane_error [m]
};

/// One node on a surface, on the sheet of it that it met first: walls that face it from across are left alone, such as
/// the inner table of a thin bone for a node in its outer one. Knows the triangles around it, so that most of its exact
/// closest points need no search.
class SurfaceContact
{
public:
  using Point = SurfaceTree::Point;

  /// Largest error of the plane within its slip [m].
  static constexpr double plane_error = 9e-6;
  static constexpr double longest_slip = 0.4e-3;  ///< [m]

  /// `distance` is the one to keep [m], signed.
  SurfaceContact(const SurfaceTree& tree, double distance) : tree_(&tree), distance_(distance) {}

  /// Plane through the exact closest point to p.
  ContactPlane renew(const Point& p);
  void forget();

private:
  static constexpr double apart = 4 * plane_error;  // from here on a distance keeps its sign

  struct Sight
  {
    const SurfaceSearch::Triangle* triangle;
    Point foot;       // its closest point
    double distance;  // to that [m]
  };
  // the triangles listed, as far as they matter
  struct Surroundings
  {
    int count = 0;
    int closest = 0;
    double outside = 0;  // all other triangles are at least so far [m]
    Sight seen[NearTriangles::capacity];
  };

  void look(const Point& p, Surroundings& s) const;
  double slip(const Point& p, const Surroundings& s, const Point& normal, double error) const;

  const SurfaceTree* tree_;
  double distance_;
  Point up_{ 0, 0, 0 };  // unit vector from the latest foot; zero: there is none
  bool turned_ = false;  // has gone round the rim of an open surface
  NearTriangles near_;
};

}  // namespace frontalis
