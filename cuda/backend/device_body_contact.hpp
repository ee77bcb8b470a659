#pragma once

#include "cuda/backend/device_fields.hpp"
#include "cuda/kernels/step_kernel.hpp"
#include "solver/contact/body_contact.hpp"

namespace frontalis
{
namespace cuda
{

struct VoxelCut;

/// Most points of contact in a patch.
std::uint32_t most_contact_points(const Model& model, const VoxelPatches& patches);

/// Contact with rigid bodies in device memory. Patches find its forces in their steps, strips in kernels before each
/// step. BodyContact adds up reactions and energies on the host, from what the device has found.
class DeviceBodyContact : public EffectPart
{
public:
  using Vectors = std::vector<std::array<double, 3>>;

  DeviceBodyContact(const Model& model, const Discretisation& discretisation, const VoxelCut& cut,
                    const std::vector<std::uint32_t>& device_node);

  bool idle() const { return host_.idle(); }
  bool in_patches() const { return patches_.size() > 0; }
  /// Fills in what a step needs.
  void describe(StepArguments& g) const;
  void list_arrays(ArrayList& list) override;
  void run(EffectSet running) override;
  void reset() override;

  /// Pushes the nodes of strips before a step; `taken_back`: takes the pushes from `v` again.
  void push(const StepArguments& g, int step, cudaStream_t stream) const;
  void take_back(const StepArguments& g, float* const (&v)[3], cudaStream_t stream) const;
  /// Adds the opposite of the forces that points have as springs to the internal forces of strips in g.u[1 - g.first].
  void add_springs(const StepArguments& g, cudaStream_t stream) const;

  // The stream must be idle.
  /// Leaves a step to the host's account. To be called after each step where energies are asked for.
  void follow(const ConstraintStep& step);
  std::vector<Reaction> reactions() const { return host_.reactions(); }
  ContactEnergy energy(const Vectors& u, const std::vector<RigidTransform>& bones, bool open, Vectors& forces);

private:
  void add_points(const Model& model);
  void add_to_patches(const VoxelPatches& patches);
  void add_to_strips(const Model& model, const std::vector<std::uint32_t>& device_node);

  BodyContact host_;
  std::vector<std::uint32_t> first_point_;  // of each voxel among the host's points, and their number
  std::vector<std::uint32_t> point_;        // of the host, of each point on the device
  std::vector<std::uint32_t> copy_;         // of each point of the host, one on the device
  DeviceFields fields_;
  DeviceArray<ContactBody> bodies_;
  DeviceArray<ContactPoint> points_;
  DeviceArray<ContactVoxel> voxels_;
  DeviceArray<PatchContact> patches_;
  DeviceArray<uint4> corners_, nodes_;
  DeviceArray<std::uint32_t> bound_;
  DeviceArray<std::int32_t> node_voxels_;
  DeviceArray<float4> pushes_, grips_, forces_, arms_, clearances_;
  DeviceArray<ContactHold> holds_;
};

}  // namespace cuda
}  // namespace frontalis
