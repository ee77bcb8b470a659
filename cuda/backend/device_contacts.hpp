#pragma once

#include "cuda/backend/device_fields.hpp"
#include "cuda/kernels/step_kernel.hpp"
#include "frontalis/model/model.hpp"
#include "solver/stepping/array_list.hpp"

#include <vector>

namespace frontalis
{
namespace cuda
{

/// Sliding nodes and the fields of their surfaces in device memory.
class DeviceContacts : public EffectPart
{
public:
  DeviceContacts(const Model& model, const std::vector<std::uint32_t>& device_node);

  /// Adds the sliding nodes to the tasks, which are indexed by model node.
  void add_tasks(std::vector<NodeTask>& task_of) const;
  /// Sets the members of `g` that describe sliding nodes.
  void describe(StepArguments& g) const;
  std::size_t rubbing() const { return friction_.size(); }  ///< nodes with friction
  void list_arrays(ArrayList& list) override;
  void run(EffectSet running) override;
  void reset() override;

private:
  bool rubs_ = true;
  std::vector<std::int32_t> node_;  // model node of each sliding node
  std::vector<bool> glides_;        // whether its surface moves with a bone
  DeviceFields surfaces_;
  DeviceArray<physics::DistanceField> fields_;
  DeviceArray<SlidingNodeField> sliding_;
  DeviceArray<float4> at_, samples_, planes_, gliding_;
  DeviceArray<float> friction_, pressing_;
};

}  // namespace cuda
}  // namespace frontalis
