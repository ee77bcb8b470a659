#pragma once

#include "cuda/backend/device_memory.hpp"
#include "solver/stepping/discretisation.hpp"
#include "solver/stepping/step_plan.hpp"
#include "frontalis/model/model.hpp"
#include "cuda/kernels/step_kernel.hpp"
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

/// Tractions, follower pressures, and the correction of gravity at nodes with scaled mass. The force on a node is a sum
/// of parts of the forces on surface vertices.
class DeviceLoads : public EffectPart
{
public:
  DeviceLoads(const Model& model, const Discretisation& discretisation, const std::vector<std::uint32_t>& device_node);

  const std::vector<std::int32_t>& nodes() const { return nodes_; }
  /// Index of the first part of each loaded node, in the order of nodes(). In device memory.
  const std::int32_t* begin() const { return begin_.data(); }
  const LoadPart* parts() const { return parts_.data(); }
  const double* vertex_force() const { return vertex_force_.data(); }
  const double* relief() const { return relief_.data(); }
  const LoadGrowth* growth() const { return growth_.data(); }

  /// Begins a plan. Without an activation, an activated load neither follows its surface nor acts.
  void begin(const StepPlan& plan);
  /// Whether a load acts in this plan.
  bool act() const { return acts_; }
  /// Whether a load that acts in this plan follows its surface, so that forces change in every step.
  bool follow() const { return follows_; }
  /// Switches loads and the correction of gravity on or off with their effects.
  void run(EffectSet running) override;
  void reset() override {}
  bool idle() const { return !(runs_ && vertex_force_.size() > 0) && !(relieves_ && relief_.size() > 0); }
  void list_arrays(ArrayList& list) override;
  /// Finds the forces on nodes in a step of the plan, if loads follow their surfaces.
  void update(StepArguments& g, int step, const float4* u, cudaStream_t stream);

private:
  struct Pressure
  {
    DeviceSurface surface;
    const Load* load;
    std::size_t first_vertex;
    bool acts;
  };

  /// Whether a load acts at any time of a plan.
  bool acts(const Load& load, const StepPlan& plan) const;

  const Model& model_;
  bool runs_ = true, relieves_ = true, acts_ = false, follows_ = false;
  std::vector<double> traction_;  // forces of tractions on the vertices, three per vertex [N]
  std::vector<std::int32_t> nodes_;
  DeviceArray<std::int32_t> begin_;
  DeviceArray<LoadPart> parts_;
  DeviceArray<double> vertex_force_, vertex_position_, node_force_, relief_;
  DeviceArray<LoadGrowth> growth_;
  std::vector<Pressure> pressures_;
};

}  // namespace cuda
}  // namespace frontalis
