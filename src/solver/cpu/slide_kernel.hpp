#pragma once

#include "solver/cpu/attach_kernel.hpp"

namespace frontalis
{

/// Up to `width` neighbouring nodes. Those that slide have the plane normal . u = offset; the normals of others are
/// zero.
template <class Real>
struct SlidingBlock
{
  static constexpr int width = 16;

  Real normal[3][width];
  Real offset[width];
  Real speed[width];         ///< velocity of the plane along its normal [m/s]
  Real reference[3][width];  ///< displacement at which the plane was found
  Real slip_squared[width];  ///< squared distance over which the plane is valid; negative: the node has no plane yet
};

/// Arguments of the kernel that moves the sliding nodes of blocks [first, last) back onto their planes. They are plain
/// pointers, for the reason given at CpuKernelArguments.
template <class Real>
struct SlideArguments
{
  SlidingBlock<Real>* blocks;
  const std::int32_t* node;   ///< first node of each block
  const std::int32_t* count;  ///< nodes in each block
  Real* u[3];
  Real* v[3];
  /// Finds a new plane for a node of a block at displacement u, and turns its velocity with the plane.
  void (*renew)(void* context, std::int32_t block, int lane, const Real u[3], Real v[3]);
  void* context;
};
template <class Real>
using SlideKernel = void (*)(const SlideArguments<Real>& arguments, std::int32_t first, std::int32_t last);

/// The kernel without SIMD, in any precision.
template <class Real>
void slide_plainly(const SlideArguments<Real>& arguments, std::int32_t first, std::int32_t last);

}  // namespace frontalis
