#pragma once

#include "cuda/backend/device_memory.hpp"
#include "frontalis/model/model.hpp"
#include "cuda/kernels/surface_kernels.hpp"

#include <vector>

namespace frontalis
{
namespace cuda
{

/// A surface, or a set of points if it has no triangles, bound to a model's voxels in device memory.
class DeviceSurface
{
public:
  DeviceSurface() = default;
  DeviceSurface(const Model& model, const std::vector<std::uint32_t>& device_node,
                const std::vector<std::array<double, 3>>& rest, const Binding& binding,
                const std::vector<std::array<std::int32_t, 3>>& triangles);

  BoundSurface view() const;
  std::size_t vertices() const { return vertices_; }
  std::size_t bytes() const;

private:
  std::size_t vertices_ = 0;
  DeviceArray<std::uint32_t> nodes_;
  DeviceArray<float> coordinates_;
  DeviceArray<double> rest_;
  DeviceArray<int3> triangles_;
  DeviceArray<std::int32_t> around_begin_, around_;
};

}  // namespace cuda
}  // namespace frontalis
