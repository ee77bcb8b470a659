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

/// A block in which nodes have left the range of their planes.
struct WaitingBlock
{
  std::int32_t block;
  std::uint32_t lanes;  ///< bits of these nodes
};

/// Arguments of the kernel that moves the sliding nodes of blocks [first, last) back onto their planes. They are plain
/// pointers, for the reason given at CpuKernelArguments.
template <class Real>
struct SlideArguments
{
  const SlidingBlock<Real>* blocks;
  const std::int32_t* node;   ///< first node of each block
  const std::int32_t* count;  ///< nodes in each block
  Real* u[3];
  Real* v[3];
  WaitingBlock* waiting;  ///< receives blocks that the kernel leaves as they are; null: it moves all nodes
};
/// Returns the number of waiting blocks.
template <class Real>
using SlideKernel = std::int32_t (*)(const SlideArguments<Real>& arguments, std::int32_t first, std::int32_t last);

/// Points in cells of distance fields, and the tangent planes there of the sets on which the fields have given levels.
struct PlaneBatch
{
  static constexpr int width = 16;

  const float* first[width];  ///< DistanceField::around() of the cell
  float place[3][width];      ///< as physics::enter_cell() returns it
  float inverse_spacing[width], level[width];
  // Found by the kernel:
  float normal[3][width], distance[width], slip[width];  ///< physics::LevelPlane
  float slope[width];                                    ///< length of the field's gradient
};
using PlaneKernel = void (*)(PlaneBatch& batch);

template <class Real>
struct SlideKernels
{
  SlideKernel<Real> slide;
  PlaneKernel planes;  ///< null: planes are found one by one
};

/// The kernels without SIMD, in any precision.
template <class Real>
SlideKernels<Real> plain_slide_kernels();

}  // namespace frontalis
