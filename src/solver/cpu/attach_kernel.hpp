#pragma once

#include <cstdint>

namespace frontalis
{

/// Number of masters of attached nodes that are processed together, one per lane. If fewer are left, the other lanes
/// are copies of the first lane.
constexpr int attach_width = 16;

/// Level sets of one node per lane, linearised: at displacement u a node has the level gradient . u + level [m].
template <class Real>
struct LevelPlanes
{
  Real gradient[3][attach_width], level[attach_width];
  Real flat[attach_width];             ///< 1 / |gradient|^2; 0: the lane has no plane
  Real reference[3][attach_width];     ///< displacement at which the plane was found
  Real slip_squared[attach_width];     ///< squared distance over which the plane is valid; negative: no plane yet
  std::int32_t surface[attach_width];  ///< index into Model::constraint_surfaces; -1: none
};

/// Held nodes that follow the masters of the lanes, one per lane. A lane whose master has no such node contains a copy
/// of another node, with weight 0.
template <class Real>
struct HeldRow
{
  std::int32_t node[attach_width];
  Real ratio[attach_width];
  Real weight[attach_width];  ///< mass times ratio
};

/// Sliding nodes that follow the masters of the lanes, one per lane. Lanes without such a node are filled as in
/// HeldRow.
template <class Real>
struct LevelRow
{
  std::int32_t node[attach_width];
  Real ratio[attach_width], weight[attach_width];
  Real offset[attach_width];  ///< level_offset() [m]
  LevelPlanes<Real> planes;
  Real u[3][attach_width], v[3][attach_width];  ///< displacement and velocity before the constraints
};

template <class Real>
struct MasterBlock
{
  std::int32_t node[attach_width];
  std::int32_t held_begin, held_end;    ///< range of AttachArguments::held
  std::int32_t level_begin, level_end;  ///< range of AttachArguments::levels
  Real held_mass[attach_width];         ///< sum of mass times squared ratio of the nodes that are held [kg]
  Real mass[attach_width];              ///< held_mass plus the master's own [kg]
  LevelPlanes<Real> planes;
};

/// Arguments of the kernel: plain pointers, for the reason given at CpuKernelArguments.
template <class Real>
struct AttachArguments
{
  MasterBlock<Real>* masters;
  const HeldRow<Real>* held;
  LevelRow<Real>* levels;
  Real* u[3];
  Real* v[3];
  Real dt;
  Real error_left;  ///< physics::error_left [m]
  /// Linearises the level of a lane's node anew, at displacement u.
  void (*renew)(void* context, LevelPlanes<Real>& planes, int lane, std::int32_t node, const Real u[3]);
  void* context;
};

/// Applies the constraints of blocks [first, last) of masters.
template <class Real>
using AttachKernel = void (*)(const AttachArguments<Real>& arguments, std::int32_t first, std::int32_t last);

/// The kernel without SIMD, for any machine and in any precision.
template <class Real>
void attach_plainly(const AttachArguments<Real>& arguments, std::int32_t first, std::int32_t last);

}  // namespace frontalis
