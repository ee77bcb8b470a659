#pragma once

#include "frontalis/physics/number.hpp"

namespace frontalis
{
namespace physics
{

/// Closest point of triangle abc to p, on its face, an edge or a corner (Voronoi regions: Ericson, Real-Time Collision
/// Detection, 5.1.5). Scalars only: the regions are branches.
template <class T>
FRONTALIS_LAW Vec3<T> closest_point(const Vec3<T>& p, const Vec3<T>& a, const Vec3<T>& b, const Vec3<T>& c)
{
  const Vec3<T> ab = b - a, ac = c - a, ap = p - a;
  const T d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0)
    return a;
  const Vec3<T> bp = p - b;
  const T d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3)
    return b;
  const T vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0)
    return a + (d1 / (d1 - d3)) * ab;
  const Vec3<T> cp = p - c;
  const T d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6)
    return c;
  const T vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0)
    return a + (d2 / (d2 - d6)) * ac;
  const T va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
    return b + ((d4 - d3) / ((d4 - d3) + (d5 - d6))) * (c - b);
  const T inverse = Number<T>::of(1) / (va + vb + vc);
  return a + (vb * inverse) * ab + (vc * inverse) * ac;
}

}  // namespace physics
}  // namespace frontalis
