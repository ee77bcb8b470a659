#pragma once

#include "cuda/backend/device_memory.hpp"
#include "cuda/kernels/bound_points.hpp"
#include "frontalis/model/model.hpp"

namespace frontalis
{
namespace cuda
{

/// Points that are bound to voxels, in device memory, for kernels that run in addition to the step kernel.
class DeviceBoundPoints
{
public:
  DeviceBoundPoints() = default;
  /// `voxel`: voxel of each point, ascending. `device_node`: device node of each model node.
  DeviceBoundPoints(const Model& model, const std::vector<std::uint32_t>& voxel, const std::vector<float4>& coordinates,
                    const std::vector<std::uint32_t>& device_node);

  BoundPoints view() const;
  /// Passes the forces on points on to nodes (launch_push_nodes()).
  void push(const StepArguments& g, float factor, float* const (&v)[3], cudaStream_t stream) const
  {
    require(launch_push_nodes(g, view(), factor, v, stream), "pushing nodes");
  }
  std::size_t bytes() const;

private:
  DeviceArray<float4> coordinates_, pushes_;
  DeviceArray<uint4> nodes_;
  DeviceArray<BoundVoxel> voxels_;
  DeviceArray<std::uint32_t> bound_;
  DeviceArray<std::int32_t> node_voxels_;
};

}  // namespace cuda
}  // namespace frontalis
