#include "cuda/backend/device_bound_points.hpp"

#include <algorithm>

namespace frontalis
{
namespace cuda
{

DeviceBoundPoints::DeviceBoundPoints(const Model& model, const std::vector<std::uint32_t>& voxel,
                                     const std::vector<float4>& coordinates,
                                     const std::vector<std::uint32_t>& device_node)
    : coordinates_(coordinates), pushes_(coordinates.size())
{
  std::vector<uint4> nodes;
  std::vector<BoundVoxel> voxels;
  std::vector<std::pair<std::uint32_t, std::pair<int, std::int32_t>>> uses;  // node, corner, voxel with points
  for (std::uint32_t first = 0, end = 0; first < voxel.size(); first = end)
  {
    while (end < voxel.size() && voxel[end] == voxel[first])
      ++end;
    std::uint32_t node[8];
    for (int b = 0; b < 8; ++b)
    {
      node[b] = device_node[model.voxel_nodes[voxel[first]][b]];
      uses.push_back({ node[b], { b, static_cast<std::int32_t>(voxels.size()) } });
    }
    for (auto p = first; p < end; ++p)
      for (const int half : { 0, 4 })
        nodes.push_back({ node[half], node[half + 1], node[half + 2], node[half + 3] });
    voxels.push_back({ 0, first, end });
  }
  std::sort(uses.begin(), uses.end());
  std::vector<std::uint32_t> bound;
  std::vector<std::int32_t> node_voxels;
  for (const auto& [node, use] : uses)
  {
    if (bound.empty() || bound.back() != node)
    {
      bound.push_back(node);
      node_voxels.resize(node_voxels.size() + 8, -1);
    }
    node_voxels[node_voxels.size() - 8 + use.first] = use.second;
  }
  nodes_ = DeviceArray<uint4>(nodes);
  voxels_ = DeviceArray<BoundVoxel>(voxels);
  bound_ = DeviceArray<std::uint32_t>(bound);
  node_voxels_ = DeviceArray<std::int32_t>(node_voxels);
}

BoundPoints DeviceBoundPoints::view() const
{
  return { coordinates_.data(),
           nodes_.data(),
           pushes_.data(),
           voxels_.data(),
           bound_.data(),
           node_voxels_.data(),
           static_cast<std::uint32_t>(coordinates_.size()),
           static_cast<std::uint32_t>(bound_.size()) };
}

std::size_t DeviceBoundPoints::bytes() const
{
  return coordinates_.bytes() + pushes_.bytes() + nodes_.bytes() + voxels_.bytes() + bound_.bytes() +
         node_voxels_.bytes();
}

}  // namespace cuda
}  // namespace frontalis
