#pragma once

#include "frontalis/physics/number.hpp"

namespace frontalis
{
namespace physics
{

/// A triangle of a surface that deforms, with unit normals of the surface at its corners, on the side of their order
/// (corner 0, 1, 2 counter-clockwise from outside).
template <class T>
struct SurfaceTriangle
{
  Vec3<T> corner[3];
  Vec3<T> normal[3];
};

/// Where a point is relative to the smooth surface that a triangle is a part of.
template <class T>
struct SurfaceFoot
{
  T gap;             ///< from the surface, negative behind it [m]
  Vec3<T> gradient;  ///< of the gap: nearly the normal
  Vec3<T> normal;    ///< of the surface, unit vector: the point is x = foot + (gap + bulge) * normal
  T weight[3];       ///< barycentric coordinates of the foot; negative: it is beyond the edge opposite to that corner
  T inside[3];       ///< the same, of the nearest point in the triangle
  T spread[3];       ///< derivatives of the gap by the corners' normals along normal - gradient [m]
  Vec3<T> mean_normal;  ///< interpolated there, its length not 1
  Vec3<T> mean_place;   ///< that point
  // the triangle's plane
  Vec3<T> facet_normal;  ///< unit vector
  T height;              ///< of the point above the plane [m]
  T below[3];            ///< barycentric coordinates of the point's orthogonal projection
  Vec3<T> slope[3];      ///< their gradients [1/m]
};

/// The point's foot on a triangle, along the normal that is interpolated between those of the corners (Phong). Across
/// the edge to a neighbour the normal and the gap are continuous: the force does not jump where a point slides on. The
/// gap is measured from the quadratic surface that belongs to these normals. It bulges over the triangle by
///   1/2 (sum of w_i n_i . a_i - (sum of w_i n_i) . (sum of w_i a_i))
/// (w barycentric coordinates, a corners, n normals): over a chord h of a circle of radius r by h^2 / (8 r) in the
/// middle. Then the normal is nearly the gradient of the gap, and a point that slides over the triangles of a curved
/// surface hardly climbs up and down. The gradient is that of the gap as it is, from the derivatives of the equation
/// of the foot, so that forces along it add no energy.
template <class T>
FRONTALIS_LAW SurfaceFoot<T> surface_foot(const SurfaceTriangle<T>& triangle, const Vec3<T>& x)
{
  using N = Number<T>;
  const Vec3<T>* const a = triangle.corner;
  const Vec3<T>* const n = triangle.normal;
  const Vec3<T> ab = a[1] - a[0], ac = a[2] - a[0], area = cross(ab, ac), ax = x - a[0];
  const T squared = N::max(dot(area, area), N::of(1e-30)), inverse = T(1) / squared, above = dot(ax, area);
  SurfaceFoot<T> foot;
  foot.slope[1] = inverse * cross(ac, area);
  foot.slope[2] = inverse * cross(area, ab);
  foot.slope[0] = T(-1) * (foot.slope[1] + foot.slope[2]);
  const T length = N::sqrt(squared);
  foot.facet_normal = (length * inverse) * area;
  foot.height = above * length * inverse;
  foot.below[1] = dot(ax, foot.slope[1]);
  foot.below[2] = dot(ax, foot.slope[2]);
  foot.below[0] = T(1) - foot.below[1] - foot.below[2];
  Vec3<T> direction{};
  T way = N::of(0), sum = T(1);
  for (int i = 0; i < 3; ++i)
    foot.weight[i] = foot.below[i];
  // Each repetition reduces the error by the height over the radius of curvature, however long the direction is.
  for (int repetition = 0; repetition < 2; ++repetition)
  {
    for (int i = 0; i < 3; ++i)
      foot.inside[i] = N::max(foot.weight[i], N::of(0));
    sum = foot.inside[0] + foot.inside[1] + foot.inside[2];
    direction = foot.inside[0] * n[0] + foot.inside[1] * n[1] + foot.inside[2] * n[2];
    // less where normals and triangle disagree by more than 78 degrees
    way = above / N::max(dot(direction, area), N::of(0.2) * length);
    for (int i = 0; i < 3; ++i)
      foot.weight[i] = foot.below[i] - way * dot(foot.slope[i], direction);
  }
  const T stretch = N::sqrt(N::max(dot(direction, direction), N::of(1e-12))), share = T(1) / sum;
  foot.normal = (T(1) / stretch) * direction;
  T counts[3];
  for (int i = 0; i < 3; ++i)
  {
    counts[i] = N::select(foot.inside[i] > T(0), T(1), T(0));
    foot.spread[i] = way * foot.inside[i];
    foot.inside[i] = share * foot.inside[i];
  }
  foot.mean_normal = share * direction;
  const Vec3<T> mean = foot.inside[1] * ab + foot.inside[2] * ac;
  foot.mean_place = a[0] + mean;
  const T bulge =
      N::of(0.5) * (foot.inside[1] * dot(n[1], ab) + foot.inside[2] * dot(n[2], ac) - dot(foot.mean_normal, mean));
  foot.gap = way * stretch - bulge;
  // The foot solves x = corner 0 + weight 1 * ab + weight 2 * ac + way * direction; of the bulge, by each weight:
  const Vec3<T> side[3] = { { T(0), T(0), T(0) }, ab, ac };
  T bulges[3];
  for (int i = 0; i < 3; ++i)
    bulges[i] = N::of(0.5) * (dot(n[i], side[i] - mean) - dot(foot.mean_normal, side[i]));
  const T all = foot.inside[0] * bulges[0] + foot.inside[1] * bulges[1] + foot.inside[2] * bulges[2];
  for (int i = 0; i < 3; ++i)
    bulges[i] = share * counts[i] * (bulges[i] - all);
  const Vec3<T> turn1 = counts[1] * n[1] - counts[0] * n[0], turn2 = counts[2] * n[2] - counts[0] * n[0];
  const Vec3<T> first = ab + way * turn1, second = ac + way * turn2, across = cross(first, second);
  foot.gradient =
      (T(1) / N::max(dot(across, direction), N::of(0.1) * length)) *
      ((way * dot(foot.normal, turn1) - bulges[1] + bulges[0]) * cross(second, direction) +
       (way * dot(foot.normal, turn2) - bulges[2] + bulges[0]) * cross(direction, first) + stretch * across);
  return foot;
}

/// The force on a corner of the triangle [N] that belongs to `pressed` times the gradient of the gap on the point. With
/// corner_turn(), those on the corners are opposite to it in sum and in moment: the gap depends on relative places.
template <class T>
FRONTALIS_LAW Vec3<T> corner_force(const SurfaceTriangle<T>& triangle, const SurfaceFoot<T>& foot, int corner,
                                   const T& pressed)
{
  const T bulging = Number<T>::of(-0.5) * pressed * foot.inside[corner];
  return bulging * (triangle.normal[corner] - foot.mean_normal) - (foot.weight[corner] * pressed) * foot.gradient;
}

/// The force on a corner that belongs to the force `along` the surface on the point. Those on the corners are opposite
/// to it in sum and in moment: forces normal to the triangle take up its couple, as it acts at the point's height.
template <class T>
FRONTALIS_LAW Vec3<T> corner_drag(const SurfaceFoot<T>& foot, int corner, const Vec3<T>& along)
{
  const T couple = foot.height * dot(foot.slope[corner], along);
  return couple * foot.facet_normal - foot.below[corner] * along;
}

/// What belongs to the normal of a corner as corner_force() to its place [N m]: the gap depends on both, and these are
/// its gradients times `pressed`, so that contact adds no energy where the surface bends.
template <class T>
FRONTALIS_LAW Vec3<T> corner_turn(const SurfaceTriangle<T>& triangle, const SurfaceFoot<T>& foot, int corner,
                                  const T& pressed)
{
  return (pressed * foot.spread[corner]) * (foot.normal - foot.gradient) +
         (Number<T>::of(-0.5) * pressed * foot.inside[corner]) * (triangle.corner[corner] - foot.mean_place);
}

/// What a corner's displacement [m] contributes to that of the triangle at the place of the point. It is zero, less the
/// point's own, in a small rigid motion of both, and the adjoint of corner_drag().
template <class T>
FRONTALIS_LAW Vec3<T> carried(const SurfaceFoot<T>& foot, int corner, const Vec3<T>& displacement)
{
  return foot.below[corner] * displacement - (foot.height * dot(foot.facet_normal, displacement)) * foot.slope[corner];
}

}  // namespace physics
}  // namespace frontalis
