#pragma once

#include "cuda/backend/device_surface.hpp"
#include "solver/stepping/discretisation.hpp"
#include "solver/stepping/step_plan.hpp"
#include "cuda/kernels/step_kernel.hpp"

#include <vector>

namespace frontalis
{
namespace cuda
{

/// Tractions, follower pressures, and the correction of gravity at nodes with scaled mass. The force on a node is a sum
/// of parts of the forces of tractions on vertices and of pressures on triangles.
class DeviceLoads : public EffectPart
{
public:
  DeviceLoads(const Model& model, const Discretisation& discretisation, const std::vector<std::uint32_t>& device_node);

  const std::vector<std::int32_t>& nodes() const { return nodes_; }
  /// Index of the first part of each loaded node, in the order of nodes(). In device memory.
  const std::int32_t* begin() const { return begin_.data(); }
  const LoadPart* parts() const { return parts_.data(); }
  const double* surface_force() const { return surface_force_.data(); }
  const double* relief() const { return relief_.data(); }
  const LoadGrowth* growth() const { return growth_.data(); }

  /// Begins a plan. An activated load acts only if it has an activation.
  void begin(const StepPlan& plan);
  /// Whether a load acts in this plan.
  bool act() const { return acts_; }
  /// End of the launch that begins with a step of this plan, if no other part ends it before `end`.
  int end_of_launch(int step, int end) const;
  /// Switches loads and the correction of gravity on or off with their effects.
  void run(EffectSet running) override;
  void reset() override {}
  bool idle() const { return !(runs_ && surface_force_.size() > 0) && !(relieves_ && relief_.size() > 0); }
  void list_arrays(ArrayList& list) override;
  /// Finds the forces on nodes in every steps_per_pressure-th step of the plan, if there are follower pressures.
  void update(StepArguments& g, int step, const float4* u, cudaStream_t stream);

private:
  /// Parts of forces on loaded nodes, by the node's index in nodes_.
  using PartsByNode = std::vector<std::vector<LoadPart>>;
  void add_traction(std::size_t load, PartsByNode& parts);
  void add_pressures(const std::vector<std::uint32_t>& device_node, PartsByNode& parts);
  std::vector<LoadPart>& of_node(std::int32_t node, PartsByNode& parts) const;
  std::vector<double> surface_forces() const;
  /// Whether a load acts at any time of a plan.
  bool acts(const Load& load, const StepPlan& plan) const;
  /// Whether forces change with the shape of surfaces in this plan.
  bool presses() const { return acts_ && pressure_.size() > 0; }

  const Model& model_;
  bool runs_ = true, relieves_ = true, acts_ = false;
  std::vector<double> traction_;  // forces of tractions on the vertices, three per vertex [N]
  std::vector<std::int32_t> nodes_;
  DeviceArray<std::int32_t> begin_;
  DeviceArray<LoadPart> parts_;
  DeviceArray<double> surface_force_, node_force_, relief_;
  DeviceArray<LoadGrowth> growth_;
  DeviceSurface pressed_;  // all surfaces under pressure
  DeviceArray<double> pressure_;
};

}  // namespace cuda
}  // namespace frontalis
