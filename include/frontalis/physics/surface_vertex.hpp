#pragma once

#include "frontalis/physics/number.hpp"

namespace frontalis
{
namespace physics
{

/// Interpolation weights of the lower and the upper side of a voxel along each axis.
template <class T>
struct SideWeights
{
  /// (a, b, c): coordinates in the voxel
  FRONTALIS_LAW SideWeights(const T& a, const T& b, const T& c)
      : x{ Number<T>::of(1) - a, a }, y{ Number<T>::of(1) - b, b }, z{ Number<T>::of(1) - c, c }
  {
  }
  T x[2], y[2], z[2];
};

/// A vertex of a surface that follows the nodes of its voxel.
template <class T>
struct SurfaceVertex
{
  Vec3<T> displacement;  ///< [m]
  Vec3<T> normal;        ///< unit vector
  /// Dual vectors of the two tangents: the normal changes by minus the sum, over both tangents, of the dual vector
  /// times (normal . change of the tangent).
  Vec3<T> dual[2];
};

template <class T>
FRONTALIS_LAW Vec3<T> by_component(const Vec3<T>& a, const Vec3<T>& b)
{
  return { a.x * b.x, a.y * b.y, a.z * b.z };
}

/// Places a vertex. `tangent`: two vectors at rest whose cross product is the normal; `inverse_spacing`: 1 over the
/// voxel's edges [1/m]; corners(i, low, high) sets the displacements [m] of the voxel's corners 2 i and 2 i + 1.
template <class T, class Corners>
FRONTALIS_LAW SurfaceVertex<T> surface_vertex(const SideWeights<T>& w, const Vec3<T> (&tangent)[2],
                                              const Vec3<T>& inverse_spacing, const Corners& corners)
{
  using N = Number<T>;
  const T none = N::of(0);
  // `sum` is the displacement; the others are its derivatives with respect to the coordinates.
  Vec3<T> sum{ none, none, none }, by_x = sum, by_y = sum, by_z = sum;
  FRONTALIS_UNROLL
  for (int two = 0; two < 4; ++two)
  {
    Vec3<T> low, high;
    corners(two, low, high);
    const int j = two & 1, k = two >> 1;
    const T weight = w.y[j] * w.z[k];
    const Vec3<T> change = high - low, moved = low + w.x[1] * change;
    sum = sum + weight * moved;
    by_x = by_x + weight * change;
    by_y = j == 0 ? by_y - w.z[k] * moved : by_y + w.z[k] * moved;
    by_z = k == 0 ? by_z - w.y[j] * moved : by_z + w.y[j] * moved;
  }
  Vec3<T> turned[2];
  FRONTALIS_UNROLL
  for (int t = 0; t < 2; ++t)
  {
    const Vec3<T> along = by_component(tangent[t], inverse_spacing);
    turned[t] = tangent[t] + along.x * by_x + along.y * by_y + along.z * by_z;
  }
  const Vec3<T> area = cross(turned[0], turned[1]);
  const T scale = N::of(1) / N::max(norm(area), N::of(1e-12));
  const Vec3<T> normal = scale * area;
  return { sum, normal, { scale * cross(turned[1], normal), scale * cross(normal, turned[0]) } };
}

/// The part of surface_node_force() that is the same for all corners: minus the generalised forces [N] that a moment on
/// the normal exerts on the derivatives, along the voxel's axes, of the displacement along the normal. `turn`:
/// generalised force on the normal [N m].
template <class T>
FRONTALIS_LAW Vec3<T> normal_forces(const Vec3<T>& turn, const Vec3<T>& dual0, const Vec3<T>& dual1,
                                    const Vec3<T> (&tangent)[2], const Vec3<T>& inverse_spacing)
{
  return by_component(dot(turn, dual0) * tangent[0] + dot(turn, dual1) * tangent[1], inverse_spacing);
}

/// Force [N] that a vertex passes on to a corner of its voxel. `force`: on the vertex [N]; `along`: normal_forces().
template <class T>
FRONTALIS_LAW Vec3<T> surface_node_force(const SideWeights<T>& w, int corner, const Vec3<T>& force,
                                         const Vec3<T>& along, const Vec3<T>& normal)
{
  const bool i = (corner & 1) != 0, j = (corner & 2) != 0, k = (corner & 4) != 0;
  const T x = i ? w.x[1] : w.x[0], y = j ? w.y[1] : w.y[0], z = k ? w.z[1] : w.z[0], none = Number<T>::of(0);
  const T by_x = y * z * along.x, by_y = z * along.y, by_z = y * along.z;
  const T across = (j ? by_y : none - by_y) + (k ? by_z : none - by_z);
  const T turned = x * across + (i ? by_x : none - by_x);
  return (x * y * z) * force - turned * normal;
}

}  // namespace physics
}  // namespace frontalis
