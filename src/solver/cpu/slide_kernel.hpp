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

/// What surfaces with friction need of the nodes of a SlidingBlock; `speed` of the block is not used then.
template <class Real>
struct RoughBlock
{
  static constexpr int width = SlidingBlock<Real>::width;

  Real bend[6][width];              ///< physics::CurvedLevel::bend: xx, yy, zz, xy, xz, yz
  Real surface_velocity[3][width];  ///< [m/s]
  Real coefficient[width];          ///< of friction
  Real outward[3][width];           ///< normal in the latest step; 0: none
  Real pressing[width];             ///< reaction per mass, delayed as friction is (physics::friction_response()) [m/s2]
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
  RoughBlock<Real>* rough;    ///< of each block; null if no surface has friction
  Real rubbing;               ///< factor on coefficients of friction
  Real response, dt;          ///< physics::friction_response(); length of the step [s]
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
  float normal[3][width], distance[width], slip[width], bend[6][width];  ///< physics::LevelPlane
  float slope[width];                                                    ///< length of the field's gradient
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
