#pragma once

#include "bake/vector.hpp"

namespace frontalis
{

/// Closest point of a triangle (Ericson, Real-Time Collision Detection 2005, 5.1.5). `feature`: see ClosestPoint.
inline Vector3d closest_on_triangle(const Vector3d& p, const Vector3d& a, const Vector3d& b, const Vector3d& c,
                                    std::int8_t& feature)
{
  const auto found = [&feature](std::int8_t on, const Vector3d& point)
  {
    feature = on;
    return point;
  };
  const Vector3d ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0)
    return found(4, a);
  const Vector3d bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3)
    return found(5, b);
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0)
    return found(1, a + (d1 / (d1 - d3)) * ab);
  const Vector3d cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6)
    return found(6, c);
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0)
    return found(3, a + (d2 / (d2 - d6)) * ac);
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
    return found(2, b + ((d4 - d3) / ((d4 - d3) + (d5 - d6))) * (c - b));
  const double scale = 1 / (va + vb + vc);
  return found(0, a + (vb * scale) * ab + (vc * scale) * ac);
}

}  // namespace frontalis
