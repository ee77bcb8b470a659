#pragma once

#include "cuda/backend/device_memory.hpp"
#include "cuda/backend/device_model.hpp"
#include "cuda/kernels/monitor_kernel.hpp"

namespace frontalis
{
namespace cuda
{

/// Computes the energies and the worst voxel of a model on the device. Allocates 44 bytes per voxel.
class DeviceMonitor
{
public:
  DeviceMonitor(const Model& model, const DeviceModel& device);

  /// Returns energies and worst voxel at displacements `u` and velocities g.v. Waits for the stream.
  Monitor read(const StepArguments& g, const float4* u, cudaStream_t stream);
  /// Limits the mobility of device nodes as StepBackend::measure_growth() says. `most`: the largest that it may become.
  void limit_mobility(const StepArguments& g, const float4* u, const float* most, float found, float* mobility,
                      cudaStream_t stream);
  /// Bytes of device memory.
  std::size_t bytes() const
  {
    return voxels_.bytes() + parts_.bytes() + stiffness_.bytes() + node_stiffness_.bytes() + stiffest_.bytes();
  }

private:
  DeviceArray<MonitorVoxel> voxels_;
  DeviceArray<PlaneMonitor> parts_{ monitor_blocks };
  PinnedArray<PlaneMonitor> seen_{ monitor_blocks };
  DeviceArray<float> stiffness_, node_stiffness_;
  DeviceArray<StiffestVoxel> stiffest_{ monitor_blocks };
  PinnedArray<StiffestVoxel> seen_stiffest_{ monitor_blocks };
  MonitorVoxels view_{};
};

}  // namespace cuda
}  // namespace frontalis
