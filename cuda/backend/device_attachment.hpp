#pragma once

#include "cuda/backend/device_memory.hpp"
#include "cuda/kernels/step_kernel.hpp"
#include "solver/stepping/attached_nodes.hpp"

#include <vector>

namespace frontalis
{
namespace cuda
{

/// The groups of a model in the form that the device needs; see AttachedArguments. The groups of a patch are
/// successive, and so are their ties and planes. Of them, or of all groups in strips, those whose nodes are all held
/// come first, and both kinds are in the order of the masters' device nodes.
struct AttachedTables
{
  /// `patches`: null in strips.
  AttachedTables(const Model& model, const std::vector<double>& mass, const std::vector<std::uint32_t>& device_node,
                 const VoxelPatches* patches);

  std::vector<AttachedGroup> groups;
  std::vector<AttachedTie> ties;
  std::vector<AttachedPlace> places;
  std::vector<PatchGroups> patch_groups;
  std::vector<std::uint32_t> grouped;

private:
  void add_group(const Model& model, const std::vector<double>& mass, const std::vector<std::uint32_t>& device_node,
                 const AttachedNode* begin, const AttachedNode* end);
  std::int32_t add_place(const Model& model, std::int32_t node, std::int32_t surface);
};

/// Largest number of words of 16 bytes that the tables of groups of a block's patches take.
std::uint32_t most_group_words(const Model& model, const VoxelPatches& patches);

/// Attached nodes and joints in device memory. It is what AttachedNodes is on host backends.
class DeviceAttachment : public EffectPart
{
public:
  DeviceAttachment(const Model& model, const std::vector<double>& mass, const std::vector<std::uint32_t>& device_node,
                   const VoxelPatches* patches);

  bool empty() const { return groups_.size() == 0; }
  /// Takes the masses of masters and attached nodes from the inverse masses in `u`.
  void take_masses(const float4* u, cudaStream_t stream) const;
  /// Sets the members of `g` that describe groups.
  void describe(StepArguments& g) const;
  void list_arrays(ArrayList& list) override;
  void run(EffectSet) override {}
  void reset() override { planes_.clear(); }

private:
  explicit DeviceAttachment(const AttachedTables& tables);

  DeviceArray<AttachedGroup> groups_;
  DeviceArray<AttachedTie> ties_;
  DeviceArray<AttachedPlace> places_;
  DeviceArray<physics::KeptLevel<float>> planes_;
  DeviceArray<PatchGroups> patches_;
  DeviceArray<std::uint32_t> grouped_;
};

}  // namespace cuda
}  // namespace frontalis
