#pragma once

#include "plane_monitor.hpp"
#include "step_kernel.hpp"

namespace frontalis
{

/// A voxel as the monitor sees it.
struct MonitorVoxel
{
  std::uint32_t node[8];  ///< device nodes
  std::uint32_t palette;
};

struct MonitorVoxels
{
  const MonitorVoxel* voxels;  ///< in the model's order
  std::uint32_t count;
  std::uint32_t nodes;  ///< device nodes
  double scale[3];      ///< 1 / (4 h)
};

/// Parts that launch_monitor() leaves, to be added up.
constexpr int monitor_blocks = 264;

/// Energies and worst voxels, in double, at displacements u.
cudaError_t launch_monitor(const StepArguments& arguments, const MonitorVoxels& voxels, const float4* u,
                           PlaneMonitor* parts, cudaStream_t stream);

}  // namespace frontalis
