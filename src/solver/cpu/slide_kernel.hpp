#pragma once

#include <cstdint>

namespace frontalis
{

/// Up to `width` neighbouring nodes and the tangent planes normal . u = offset of those that slide. The others have a
/// normal of 0 and an infinite slip.
template <class Real>
struct SlidingBlock
{
  static constexpr int width = 16;

  Real normal[3][width];
  Real offset[width];
  Real reference[3][width];  ///< displacement at the latest exact closest point
  Real slip_squared[width];  ///< squared distance over which the plane is valid; < 0: there is no plane yet
};

/// Puts the sliding nodes of blocks [first, last) back to their planes. Plain pointers, as for CpuKernel.
template <class Real>
struct SlideArguments
{
  SlidingBlock<Real>* blocks;
  const std::int32_t* node;   ///< first node of a block
  const std::int32_t* count;  ///< nodes of a block
  Real* u[3];
  Real* v[3];
  /// Finds the plane of one node of a block anew, at displacement u; turns its velocity with the plane.
  void (*renew)(void* context, std::int32_t block, int lane, const Real u[3], Real v[3]);
  void* context;
};
template <class Real>
using SlideKernel = void (*)(const SlideArguments<Real>& arguments, std::int32_t first, std::int32_t last);

/// The same without SIMD, in any precision.
template <class Real>
void slide_plainly(const SlideArguments<Real>& arguments, std::int32_t first, std::int32_t last);

}  // namespace frontalis
