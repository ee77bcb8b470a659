#pragma once

#include "solver/energy/plane_monitor.hpp"
#include "cuda/kernels/step_kernel.hpp"

namespace frontalis
{

/// A voxel in the form that the monitor reads.
struct MonitorVoxel
{
  std::uint32_t node[8];  ///< device nodes
  std::uint32_t palette;
};

struct MonitorVoxels
{
  const MonitorVoxel* voxels;  ///< in the model's order
  std::uint32_t count;
  std::uint32_t nodes;    ///< number of device nodes
  double scale[3];        ///< 1 / (4 h)
  float* stiffness;       ///< temporary: bound of each voxel [N/m]
  float* node_stiffness;  ///< temporary: sum of the bounds at each node [N/m]
};

/// The highest squared frequency bound [1/s2] among the nodes of some voxels, and the stiffest voxel at that node.
struct StiffestVoxel
{
  float frequency_squared = 0;
  float stiffness = 0;  ///< bound [N/m]
  std::int32_t voxel = -1;

  /// Keeps the entry with the higher frequency bound or, if the bounds are equal, the entry with the stiffer voxel. The
  /// result of several calls does not depend on their order. Values that are not finite count as the largest.
  FRONTALIS_LAW void add(const StiffestVoxel& part)
  {
    const bool none = frequency_squared != frequency_squared;
    const bool larger = !none && !(part.frequency_squared <= frequency_squared);
    const bool same = part.voxel >= 0 && part.frequency_squared == frequency_squared;
    if (larger || (same && (part.stiffness > stiffness || (part.stiffness == stiffness && part.voxel < voxel))))
      *this = part;
  }
};

/// Number of partial sums that launch_monitor() writes.
constexpr int monitor_blocks = 264;

/// Computes energies, worst voxels and stiffest voxels at displacements `u`, in double precision.
cudaError_t launch_monitor(const StepArguments& arguments, const MonitorVoxels& voxels, const float4* u,
                           PlaneMonitor* parts, StiffestVoxel* stiffest, cudaStream_t stream);

/// Writes the smaller of each node's `most` [1/kg] and `found` [1/s2] over the sum of the bounds of its voxels at `u`
/// [N/m] to `mobility`, which may be the same memory.
cudaError_t launch_limit_mobility(const StepArguments& arguments, const MonitorVoxels& voxels, const float4* u,
                                  PlaneMonitor* parts, const float* most, float found, float* mobility,
                                  cudaStream_t stream);

/// Writes the bits of the largest speed of device nodes [m/s] to `bits`, which must be 0 before. `nodes`: their number,
/// including the placeholder, node 0.
cudaError_t launch_largest_speed(const StepArguments& arguments, std::uint32_t nodes, std::uint32_t* bits,
                                 cudaStream_t stream);

}  // namespace frontalis
