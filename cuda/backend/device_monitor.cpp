#include "cuda/backend/device_monitor.hpp"

namespace frontalis
{
namespace cuda
{

DeviceMonitor::DeviceMonitor(const Model& model, const DeviceModel& device)
{
  std::vector<MonitorVoxel> voxels(model.voxels.size());
  for (std::size_t e = 0; e < voxels.size(); ++e)
  {
    for (int b = 0; b < 8; ++b)
      voxels[e].node[b] = device.device_node()[model.voxel_nodes[e][b]];
    voxels[e].palette = device.palette_of_voxel()[e];
  }
  voxels_ = DeviceArray<MonitorVoxel>(voxels);
  view_.voxels = voxels_.data();
  view_.count = static_cast<std::uint32_t>(voxels.size());
  view_.nodes = static_cast<std::uint32_t>(device.nodes());
  stiffness_ = DeviceArray<float>(voxels.size());
  node_stiffness_ = DeviceArray<float>(device.nodes());
  view_.stiffness = stiffness_.data();
  view_.node_stiffness = node_stiffness_.data();
  for (int axis = 0; axis < 3; ++axis)
    view_.scale[axis] = 0.25 / model.spacing[axis];
}

Monitor DeviceMonitor::read(const StepArguments& g, const float4* u, cudaStream_t stream)
{
  require(launch_monitor(g, view_, u, parts_.data(), stiffest_.data(), stream), "reading the voxels");
  require(cudaMemcpyAsync(seen_.data(), parts_.data(), parts_.bytes(), cudaMemcpyDeviceToHost, stream),
          "copying what the monitor saw");
  require(cudaMemcpyAsync(seen_stiffest_.data(), stiffest_.data(), stiffest_.bytes(), cudaMemcpyDeviceToHost, stream),
          "copying what the monitor saw");
  require(cudaStreamSynchronize(stream), "reading the voxels");
  PlaneMonitor sum;
  StiffestVoxel stiffest;
  for (int part = 0; part < monitor_blocks; ++part)
  {
    sum.add(seen_.data()[part]);
    stiffest.add(seen_stiffest_.data()[part]);
  }
  return monitor_of(sum, double(stiffest.frequency_squared), stiffest.voxel);
}

void DeviceMonitor::limit_mobility(const StepArguments& g, const float4* u, const float* most, float found,
                                   float* mobility, cudaStream_t stream)
{
  require(launch_limit_mobility(g, view_, u, parts_.data(), most, found, mobility, stream), "measuring growth");
}

}  // namespace cuda
}  // namespace frontalis
