#pragma once

#include "frontalis/physics/number.hpp"

namespace frontalis
{
namespace physics
{

/// Weights of a voxel's corners b = i + 2j + 4k at the coordinates (x, y, z), which are 0 to 1 inside the voxel and may
/// lie outside of it.
template <class T>
FRONTALIS_LAW void trilinear_weights(T x, T y, T z, T* weight)
{
  const T one = Number<T>::of(1);
  for (int b = 0; b < 8; ++b)
    weight[b] = ((b & 1) ? x : one - x) * ((b & 2) ? y : one - y) * ((b & 4) ? z : one - z);
}

}  // namespace physics
}  // namespace frontalis
