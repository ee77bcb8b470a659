#pragma once

#include "cuda/backend/device_memory.hpp"
#include "solver/stepping/discretisation.hpp"
#include "frontalis/model/model.hpp"
#include "cuda/kernels/step_kernel.hpp"
#include "cuda/kernels/surface_kernels.hpp"

#include <vector>

namespace frontalis
{
namespace cuda
{

/// A surface (or points, where it has no triangles) bound to a model's voxels, in device memory.
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

/// Tractions, follower pressures, and the relief from gravity of nodes whose mass is scaled. Each node of a load takes
/// parts of the forces at the load's vertices.
class DeviceLoads
{
public:
  DeviceLoads(const Model& model, const Discretisation& discretisation, const std::vector<std::uint32_t>& device_node);

  /// Where each loaded model node's parts begin, in the order of nodes().
  const std::vector<std::int32_t>& nodes() const { return nodes_; }
  const std::int32_t* begin() const { return begin_.data(); }
  const LoadPart* parts() const { return parts_.data(); }
  const double* vertex_force() const { return vertex_force_.data(); }
  const double* relief() const { return relief_.data(); }
  const double* ramp() const { return ramp_.data(); }

  /// True where forces follow the surface, so that they change with every step.
  bool follow() const { return runs_ && !pressures_.empty(); }
  /// Loads and relief from gravity act only where their effects run.
  void run(EffectSet running);
  bool idle() const { return !(runs_ && vertex_force_.size() > 0) && !(relieves_ && relief_.size() > 0); }
  void list_allocations(AllocationList& list) const;
  void update(const float4* u, cudaStream_t stream);

private:
  struct Pressure
  {
    DeviceSurface surface;
    double value;
    std::size_t first_vertex;
  };

  bool runs_ = true, relieves_ = true;
  std::vector<double> traction_;  // vertex forces of dead loads
  std::vector<std::int32_t> nodes_;
  DeviceArray<std::int32_t> begin_;
  DeviceArray<LoadPart> parts_;
  DeviceArray<double> vertex_force_, vertex_position_, ramp_, relief_;
  std::vector<Pressure> pressures_;
};

}  // namespace cuda
}  // namespace frontalis
