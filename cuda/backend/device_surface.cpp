#include "cuda/backend/device_surface.hpp"

namespace frontalis
{
namespace cuda
{

DeviceSurface::DeviceSurface(const Model& model, const std::vector<std::uint32_t>& device_node,
                             const std::vector<std::array<double, 3>>& rest, const Binding& binding,
                             const std::vector<std::array<std::int32_t, 3>>& triangles)
    : vertices_(rest.size())
{
  std::vector<std::uint32_t> nodes;
  std::vector<float> coordinates;
  std::vector<double> positions;
  for (std::size_t v = 0; v < rest.size(); ++v)
  {
    for (const auto node : model.voxel_nodes[binding.voxel[v]])
      nodes.push_back(device_node[node]);
    coordinates.insert(coordinates.end(), binding.coordinates[v].begin(), binding.coordinates[v].end());
    positions.insert(positions.end(), rest[v].begin(), rest[v].end());
  }
  std::vector<int3> corners;
  std::vector<std::int32_t> begin(rest.size() + 1, 0);
  for (const auto& t : triangles)
  {
    corners.push_back(int3{ t[0], t[1], t[2] });
    for (const auto corner : t)
      ++begin[corner + 1];
  }
  for (std::size_t v = 0; v < rest.size(); ++v)
    begin[v + 1] += begin[v];
  std::vector<std::int32_t> around(3 * triangles.size()), next(begin.begin(), begin.end() - 1);
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (const auto corner : triangles[t])
      around[next[corner]++] = static_cast<std::int32_t>(t);
  nodes_ = DeviceArray<std::uint32_t>(nodes);
  coordinates_ = DeviceArray<float>(coordinates);
  rest_ = DeviceArray<double>(positions);
  triangles_ = DeviceArray<int3>(corners);
  around_begin_ = DeviceArray<std::int32_t>(begin);
  around_ = DeviceArray<std::int32_t>(around);
}

BoundSurface DeviceSurface::view() const
{
  return { static_cast<std::uint32_t>(vertices_),
           static_cast<std::uint32_t>(triangles_.size()),
           nodes_.data(),
           coordinates_.data(),
           rest_.data(),
           triangles_.data(),
           around_begin_.data(),
           around_.data() };
}

std::size_t DeviceSurface::bytes() const
{
  return nodes_.bytes() + coordinates_.bytes() + rest_.bytes() + triangles_.bytes() + around_begin_.bytes() +
         around_.bytes();
}

}  // namespace cuda
}  // namespace frontalis
