#pragma once

#include "frontalis/physics/number.hpp"
#include "frontalis/scene/geometry.hpp"

#include <Eigen/Geometry>

// Standard headers that nearly every file of the bake uses:
#include <algorithm>
#include <cmath>
#include <cstdint>

namespace frontalis
{

// The bake uses Eigen's vectors and boxes [m]; scenes and models hold plain arrays.
using Eigen::Vector3d;
using Box = Eigen::AlignedBox3d;

using physics::pi;

inline Vector3d to_vector(const Vector3& a) { return { a[0], a[1], a[2] }; }
inline Vector3 to_array(const Vector3d& v) { return { v[0], v[1], v[2] }; }
inline Box to_box(const Region& region) { return { to_vector(region.lower), to_vector(region.upper) }; }

inline double squared_distance_to_segment(const Vector3d& p, const Vector3d& a, const Vector3d& b)
{
  const Vector3d ab = b - a;
  const double length = ab.squaredNorm();
  const double t = length > 0 ? std::min(1.0, std::max(0.0, (p - a).dot(ab) / length)) : 0;
  return (a + t * ab - p).squaredNorm();
}

/// Point i of a low-discrepancy sequence in a box (R3: Roberts, The unreasonable effectiveness of quasirandom
/// sequences, 2018).
inline Vector3d spread_point(const Box& box, int i)
{
  // The steps along the axes are 1/g, 1/g^2 and 1/g^3 with g^4 = g + 1.
  const Vector3d step{ 0.8191725133961645, 0.6710436067037893, 0.5497004779019703 };
  Vector3d p;
  for (int a = 0; a < 3; ++a)
    p[a] = box.min()[a] + std::fmod(0.5 + (i + 1) * step[a], 1.0) * (box.max()[a] - box.min()[a]);
  return p;
}

}  // namespace frontalis
