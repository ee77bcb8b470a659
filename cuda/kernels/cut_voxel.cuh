#pragma once

#include "cuda/kernels/element_stress.cuh"
#include "frontalis/physics/cut_voxels.hpp"

namespace frontalis
{
namespace cuda
{

/// Centroid of the tissue of voxels with this palette entry.
__device__ __forceinline__ physics::TissueCentre<float> tissue_centre(const StepArguments& g, std::uint32_t palette)
{
  const float4 centre = __ldg(g.centres + palette);
  return { centre.x, centre.y, centre.z };
}

/// Factors on the stiffness bound of a voxel at its corners.
struct CornerFactors
{
  float at[8];
};

__device__ __forceinline__ CornerFactors corner_factors(const StepArguments& g, std::uint32_t palette)
{
  const float4 low = __ldg(g.corner_stiffness + 2 * palette), high = __ldg(g.corner_stiffness + 2 * palette + 1);
  return { { low.x, low.y, low.z, low.w, high.x, high.y, high.z, high.w } };
}

/// Sums of the stiffness bounds at the nodes of a strip that has cut voxels, whose corners have bounds of their own.
template <int Rows>
struct CornerBounds
{
  float carried[Rows][2];  ///< from the voxels below the plane of nodes: at a voxel's corners of low and high x
  float pending[2][2];     ///< from the row of voxels before, at its further corners: [low or high z][low or high x]

  __device__ __forceinline__ void begin_plane()
  {
    for (auto& side : pending)
      side[0] = side[1] = 0;
  }
  /// Adds the bound of the voxel in row `row`. Returns the sum at the node of that row; row 0 has none.
  __device__ __forceinline__ float add(const StepArguments& g, std::uint32_t palette, float stiffness, int row,
                                       int left)
  {
    const CornerFactors factor = corner_factors(g, palette);
    float sum = 0;
    if (row > 0)
    {
      float(&below)[2] = carried[row - 1];
      const float own = below[0] + pending[0][0] + stiffness * factor.at[0];
      const float right = below[1] + pending[0][1] + stiffness * factor.at[1];
      sum = own + __shfl_sync(whole_warp, right, left);
      below[0] = pending[1][0] + stiffness * factor.at[4];
      below[1] = pending[1][1] + stiffness * factor.at[5];
    }
#pragma unroll
    for (int x = 0; x < 2; ++x)
    {
      pending[0][x] = stiffness * factor.at[2 + x];
      pending[1][x] = stiffness * factor.at[6 + x];
    }
    return sum;
  }
};

}  // namespace cuda
}  // namespace frontalis
