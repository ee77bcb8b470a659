#pragma once

#include "cuda/kernels/bound_points.hpp"
#include "frontalis/physics/trilinear.hpp"

namespace frontalis
{
namespace cuda
{

/// Adds the displacement `u` of a voxel's corner, times its weight w, to `sum`.
__device__ __forceinline__ void add_part(physics::Vec3<float>& sum, float w, const float4& u)
{
  sum = sum + w * physics::Vec3<float>{ u.x, u.y, u.z };
}

/// Weight of corner b of a voxel at coordinates (x, y, z).
__device__ __forceinline__ float corner_weight(std::uint32_t b, float x, float y, float z)
{
  return (b & 1 ? x : 1 - x) * (b & 2 ? y : 1 - y) * (b & 4 ? z : 1 - z);
}

/// Displacement of a point with these coordinates in a voxel. `low`, `high`: the voxel's corners, as indices into `u`.
__device__ __forceinline__ physics::Vec3<float> bound_displacement(const float4& coordinates, const uint4& low,
                                                                   const uint4& high, const float4* u)
{
  const std::uint32_t corner[8] = { low.x, low.y, low.z, low.w, high.x, high.y, high.z, high.w };
  float weight[8];
  physics::trilinear_weights(coordinates.x, coordinates.y, coordinates.z, weight);
  physics::Vec3<float> moved{ 0, 0, 0 };
  FRONTALIS_UNROLL
  for (int b = 0; b < 8; ++b)
    add_part(moved, weight[b], u[corner[b]]);
  return moved;
}

}  // namespace cuda
}  // namespace frontalis
