#pragma once

#include "cuda/backend/contact_point.hpp"
#include "cuda/backend/device_fields.hpp"
#include "cuda/backend/device_part.hpp"

namespace frontalis
{
namespace cuda
{

/// Contact with rigid bodies in device memory. Patches find its forces in their steps, strips in kernels before each
/// step. BodyContact adds up reactions and energies on the host, from what the device has found.
class DeviceBodyContact : public DevicePart
{
public:
  DeviceBodyContact(const Model& model, const Discretisation& discretisation, const VoxelCut& cut,
                    const std::vector<std::uint32_t>& device_node);

  bool idle() const override { return host_.idle(); }
  bool in_patches() const override { return patches_.size() > 0; }
  void describe(StepArguments& g) const override;
  void list_arrays(ArrayList& list) override;
  void run(EffectSet running) override;
  void reset() override;
  void push(const StepArguments& g, int step, cudaStream_t stream) const override;
  void take_back(const StepArguments& g, float* const (&v)[3], cudaStream_t stream) const override;
  void add_springs(const StepArguments& g, cudaStream_t stream) const override;
  void follow(const ConstraintStep& step) override;
  std::vector<Reaction> reactions() const override { return host_.reactions(); }
  std::int64_t lost_points() const override;
  std::vector<float> motion(const std::vector<std::vector<RigidTransform>>& bones) const override;
  void add_energies(const Vectors& u, const std::vector<RigidTransform>& bones, bool open, Vectors& forces,
                    EnergyLedger& ledger) override;

private:
  void add_points(const Model& model);
  void add_to_patches(const VoxelPatches& patches);
  void add_to_strips(const Model& model, const std::vector<std::uint32_t>& device_node);

  HostContact host_;
  std::vector<std::uint32_t> first_point_;  // of each voxel among the host's points, and their number
  std::vector<std::uint32_t> point_;        // of the host, of each point on the device
  std::vector<std::uint32_t> copy_;         // of each point of the host, one on the device
  std::array<double, 3> far_corner_;        // of the grid [m]
  DeviceFields fields_;
  std::vector<ContactBody> host_bodies_;
  DeviceArray<ContactBody> bodies_;
  DeviceArray<ContactPoint> points_;
  DeviceArray<ContactVoxel> voxels_;
  DeviceArray<PatchContact> patches_;
  DeviceArray<uint4> corners_, nodes_;
  DeviceArray<std::uint32_t> bound_;
  DeviceArray<std::int32_t> node_voxels_;
  DeviceArray<float4> watched_, pushes_, samples_, clearances_;
  DeviceArray<float4> grips_, forces_, arms_;
  DeviceArray<ContactHold> holds_;
};

}  // namespace cuda
}  // namespace frontalis
