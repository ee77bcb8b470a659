#pragma once

#include "cuda/backend/device_memory.hpp"
#include "cuda/kernels/attachment_arguments.hpp"
#include "solver/stepping/attached_nodes.hpp"

#include <vector>

namespace frontalis
{
namespace cuda
{

/// Whether nodes of the model follow others, because they are attached or joined.
inline bool has_followers(const Model& model) { return !model.attached.empty() || !model.joints.empty(); }

/// The groups of a model in the form that the device needs; see AttachedArguments. Groups whose nodes are all held come
/// first, and within both kinds the order is that of the masters' device nodes.
struct AttachedTables
{
  AttachedTables(const Model& model, const std::vector<double>& mass, const std::vector<std::uint32_t>& device_node);

  std::vector<AttachedGroup> groups;
  std::vector<AttachedTie> ties;
  std::vector<AttachedPlace> places;

private:
  std::int32_t add_place(const Model& model, std::int32_t node, std::int32_t surface);
};

/// Attached nodes and joints in device memory, and the kernel that moves them with their masters after each step. It is
/// what AttachedNodes is on host backends.
class DeviceAttachment : public EffectPart
{
public:
  DeviceAttachment(const Model& model, const std::vector<double>& mass, const std::vector<std::uint32_t>& device_node);

  bool empty() const { return groups_.size() == 0; }
  /// Applies the constraints after the only step of a launch with the arguments `g`.
  void follow(const StepArguments& g, cudaStream_t stream) const;
  void list_arrays(ArrayList& list) override;
  void run(EffectSet) override {}
  void reset() override { planes_.clear(); }

private:
  explicit DeviceAttachment(const AttachedTables& tables);

  DeviceArray<AttachedGroup> groups_;
  DeviceArray<AttachedTie> ties_;
  DeviceArray<AttachedPlace> places_;
  DeviceArray<physics::KeptLevel<float>> planes_;
};

}  // namespace cuda
}  // namespace frontalis
