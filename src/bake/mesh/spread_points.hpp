#pragma once

#include "bake/vector.hpp"

#include <cmath>

namespace frontalis
{

/// Point i of a low-discrepancy sequence in a box (R3: Roberts, The unreasonable effectiveness of quasirandom
/// sequences, 2018).
inline Vector3d spread_point(const Box& box, int i)
{
  // 1/g, 1/g^2, 1/g^3 with g^4 = g + 1
  const Vector3d step{ 0.8191725133961645, 0.6710436067037893, 0.5497004779019703 };
  Vector3d p;
  for (int a = 0; a < 3; ++a)
    p[a] = box.min()[a] + std::fmod(0.5 + (i + 1) * step[a], 1.0) * (box.max()[a] - box.min()[a]);
  return p;
}

}  // namespace frontalis
