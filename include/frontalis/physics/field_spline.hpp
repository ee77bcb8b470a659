#pragma once

#include "frontalis/physics/number.hpp"

namespace frontalis
{
namespace physics
{

/// A distance field and its derivatives at one point.
template <class T>
struct FieldValue
{
  T value;           ///< [m]
  Vec3<T> gradient;  ///< close to a unit vector, shorter on ridges and in furrows
  T curvature;       ///< Frobenius norm of the Hessian [1/m]
  T reach;           ///< distance over which `curvature` describes the field well enough for a tangent plane [m]
  SymmetricMatrix<T> hessian{};  ///< [1/m]
};

/// Largest error [m] of a tangent plane that replaces a level set. It is small, because changes of plane excite
/// vibrations.
constexpr double plane_error = 0.5e-6;

/// The samples of a cell, x fastest [m].
struct FieldSamples
{
  float value[27];
};

/// Evaluates the spline at `place` in a cell, from `samples` like FieldSamples. Place and cell are those of
/// enter_cell(). Its second derivatives may jump at the cell's faces, but are at most 2 / spacing, because distances of
/// neighbouring samples differ by at most the spacing.
template <class T, class Samples>
FRONTALIS_LAW FieldValue<T> spline(const Samples& samples, const T& inverse_spacing, const Vec3<T>& place)
{
  using N = Number<T>;
  const T x[3] = { place.x, place.y, place.z };
  // Weights of the value and of the first derivative. Those of the second derivative are 1, -2, 1.
  T w[3][3], d[3][3];
  for (int axis = 0; axis < 3; ++axis)
  {
    const T before = T(0.5) - x[axis], after = T(0.5) + x[axis];
    w[axis][0] = T(0.5) * before * before;
    w[axis][1] = T(0.75) - x[axis] * x[axis];
    w[axis][2] = T(0.5) * after * after;
    d[axis][0] = -before;
    d[axis][1] = T(-2) * x[axis];
    d[axis][2] = after;
  }
  const auto sum = [](const T(&weight)[3], const T(&of)[3])
  { return weight[0] * of[0] + weight[1] * of[1] + weight[2] * of[2]; };
  const auto bend = [](const T(&of)[3]) { return of[0] - T(2) * of[1] + of[2]; };
  T f[3], fx[3], fy[3], fxx[3], fxy[3], fyy[3];  // sums in each plane of samples
  FRONTALIS_UNROLL
  for (int k = 0; k < 3; ++k)
  {
    T g[3], gx[3], gxx[3];  // sums in each row of the plane
    FRONTALIS_UNROLL
    for (int j = 0; j < 3; ++j)
    {
      const auto* const row = samples.value + 9 * k + 3 * j;
      const T of[3] = { T(row[0]), T(row[1]), T(row[2]) };
      g[j] = sum(w[0], of);
      gx[j] = sum(d[0], of);
      gxx[j] = bend(of);
    }
    f[k] = sum(w[1], g);
    fx[k] = sum(w[1], gx);
    fy[k] = sum(d[1], g);
    fxx[k] = sum(w[1], gxx);
    fxy[k] = sum(d[1], gx);
    fyy[k] = bend(g);
  }
  const T xx = sum(w[2], fxx), yy = sum(w[2], fyy), zz = bend(f);
  const T xy = sum(w[2], fxy), xz = sum(d[2], fx), yz = sum(d[2], fy);
  T to_face = T(0.5);
  for (int axis = 0; axis < 3; ++axis)
    to_face = N::min(to_face, T(0.5) - N::max(x[axis], -x[axis]));
  const T spacing = T(1) / inverse_spacing;
  const T squared = xx * xx + yy * yy + zz * zz + T(2) * (xy * xy + xz * xz + yz * yz);
  return { sum(w[2], f), inverse_spacing * Vec3<T>{ sum(w[2], fx), sum(w[2], fy), sum(d[2], f) },
           inverse_spacing * inverse_spacing * N::sqrt(squared),
           N::max(to_face * spacing, N::sqrt(N::of(plane_error) * spacing)),
           scaled(inverse_spacing * inverse_spacing, SymmetricMatrix<T>{ xx, yy, zz, xy, xz, yz }) };
}

/// Distance of a point from a sphere as a FieldValue. The point has moved by `way` [m] from a place that is `offset`
/// [m] from the sphere's centre and `distance` [m] from its surface. If the caller finds `offset` and `distance` in
/// double precision, single precision suffices here: rounding errors are then in proportion to the distance moved, not
/// to the size of the sphere.
template <class T>
FRONTALIS_LAW FieldValue<T> sphere_value(const T& distance, const Vec3<T>& offset, const Vec3<T>& way)
{
  const Vec3<T> now = offset + way;
  const T from_centre = Number<T>::max(norm(now), T(1e-9));
  const Vec3<T> n = (T(1) / from_centre) * now;
  const T bend = T(1) / from_centre;
  // A difference of two lengths is the difference of their squares divided by their sum; this form avoids cancellation.
  return { distance + dot(T(2) * offset + way, way) / (from_centre + norm(offset)),
           n,
           T(1.4142136) / from_centre,
           from_centre,
           { bend * (T(1) - n.x * n.x), bend * (T(1) - n.y * n.y), bend * (T(1) - n.z * n.z), -bend * n.x * n.y,
             -bend * n.x * n.z, -bend * n.y * n.z } };
}

}  // namespace physics
}  // namespace frontalis
