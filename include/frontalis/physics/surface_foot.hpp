#pragma once

#include "frontalis/physics/number.hpp"

namespace frontalis
{
namespace physics
{

/// A triangle of a surface that deforms, with unit normals of the surface at its corners. The normals point to the side
/// from which corners 0, 1, 2 are counter-clockwise.
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
  T gap;             ///< distance of the point from the surface, negative behind it [m]
  Vec3<T> gradient;  ///< derivative of the gap with respect to the point: nearly the normal
  Vec3<T> normal;    ///< unit normal of the surface: the point is x = foot + (gap + bulge) * normal
  T weight[3];       ///< barycentric coordinates of the foot; negative beyond the edge opposite to the corner
  T inside[3];       ///< barycentric coordinates of the nearest point in the triangle
  T spread[3];  ///< factors of (normal - gradient) in the gap's derivatives with respect to the corners' normals [m]
  Vec3<T> mean_normal;   ///< corner normals interpolated at the nearest point in the triangle; not of length 1
  Vec3<T> mean_place;    ///< the nearest point in the triangle
  Vec3<T> facet_normal;  ///< unit normal of the triangle's plane
  T height;              ///< height of the point above the plane [m]
  T below[3];            ///< barycentric coordinates of the point's projection onto the plane
  Vec3<T> slope[3];      ///< gradients of these coordinates [1/m]
};

/// Finds the point's foot on a triangle along the normal that is interpolated between the corners' normals (Phong).
/// This normal and the gap are continuous across the edge to a neighbour, so that the force does not jump when a point
/// slides from one triangle to the next. The gap is measured from the quadratic surface that belongs to the normals,
/// which is above the triangle by
///   1/2 (sum of w_i n_i . a_i - (sum of w_i n_i) . (sum of w_i a_i))
/// (w barycentric coordinates, a corners, n normals): in the middle of a chord h of a circle of radius r by h^2/(8r).
/// The normal is thus nearly the gradient of the gap, and a point that slides over the triangles of a curved surface
/// hardly climbs up and down. `gradient` is the exact gradient, from the derivatives of the equation of the foot, so
/// that forces along it add no energy.
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
  // Fixed-point iteration: each repetition multiplies the error by the ratio of the height to the radius of curvature.
  for (int repetition = 0; repetition < 2; ++repetition)
  {
    for (int i = 0; i < 3; ++i)
      foot.inside[i] = N::max(foot.weight[i], N::of(0));
    sum = foot.inside[0] + foot.inside[1] + foot.inside[2];
    direction = foot.inside[0] * n[0] + foot.inside[1] * n[1] + foot.inside[2] * n[2];
    // The lower limit applies where the interpolated normal is more than 78 degrees from the triangle's normal.
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
  // x = corner 0 + weight 1 * ab + weight 2 * ac + way * direction; bulges[i]: d(bulge) / d(weight i).
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

/// Force on a corner of the triangle [N] if the force on the point is `pressed` times the gradient of the gap. With the
/// moments of corner_turn(), the corners' forces balance that force in sum and moment.
template <class T>
FRONTALIS_LAW Vec3<T> corner_force(const SurfaceTriangle<T>& triangle, const SurfaceFoot<T>& foot, int corner,
                                   const T& pressed)
{
  const T bulging = Number<T>::of(-0.5) * pressed * foot.inside[corner];
  return bulging * (triangle.normal[corner] - foot.mean_normal) - (foot.weight[corner] * pressed) * foot.gradient;
}

/// Force on a corner [N] if the force on the point is `along` [N], which is tangential to the surface. The corners'
/// forces balance that force in sum and in moment, for which they need parts normal to the triangle.
template <class T>
FRONTALIS_LAW Vec3<T> corner_drag(const SurfaceFoot<T>& foot, int corner, const Vec3<T>& along)
{
  const T couple = foot.height * dot(foot.slope[corner], along);
  return couple * foot.facet_normal - foot.below[corner] * along;
}

/// Generalised force [N m] on the normal of a corner; corner_force() is the force on the corner's position. The gap
/// depends on both, so that contact adds no energy on a bending surface if both are applied.
template <class T>
FRONTALIS_LAW Vec3<T> corner_turn(const SurfaceTriangle<T>& triangle, const SurfaceFoot<T>& foot, int corner,
                                  const T& pressed)
{
  return (pressed * foot.spread[corner]) * (foot.normal - foot.gradient) +
         (Number<T>::of(-0.5) * pressed * foot.inside[corner]) * (triangle.corner[corner] - foot.mean_place);
}

/// Contribution of a corner's displacement to the displacement [m] of the triangle at the point; the adjoint of
/// corner_drag(). In a small rigid motion of triangle and point, the contributions add up to the point's displacement.
template <class T>
FRONTALIS_LAW Vec3<T> carried(const SurfaceFoot<T>& foot, int corner, const Vec3<T>& displacement)
{
  return foot.below[corner] * displacement - (foot.height * dot(foot.facet_normal, displacement)) * foot.slope[corner];
}

}  // namespace physics
}  // namespace frontalis
