#pragma once

#include "cuda/backend/contact_point.hpp"
#include "cuda/backend/device_bound_points.hpp"
#include "cuda/backend/device_fields.hpp"
#include "cuda/backend/device_part.hpp"
#include "cuda/kernels/pushed_bodies.hpp"

namespace frontalis
{
namespace cuda
{

/// Largest number of contact points in a patch.
std::uint32_t most_touching_points(const Model& model, const VoxelPatches& patches);

/// Contact with rigid bodies in device memory. Patches find its forces within their steps; for strips, kernels find
/// them before each step. BodyContact adds up reactions and energies on the host from the device's results.
class DeviceBodyContact : public DevicePart
{
public:
  DeviceBodyContact(const Model& model, const Discretisation& discretisation, const VoxelCut& cut,
                    const std::vector<std::uint32_t>& device_node);

  bool idle() const override { return host_.idle(); }
  Effects effects() const override { return point_.empty() ? Effects::none : of_nodes | Effects::contact; }
  void describe(StepArguments& g) const override;
  void list_arrays(ArrayList& list) override;
  void run(EffectSet running) override;
  void reset() override;
  std::uint32_t blocks_beside() const override;
  void find_pushes(const StepArguments& g, int step, cudaStream_t stream) const override;
  void push(const StepArguments& g, float factor, float* const (&v)[3], cudaStream_t stream) const override
  {
    bound_.push(g, factor, v, stream);
  }
  void follow(const ConstraintStep& step) override;
  std::vector<Reaction> reactions() const override { return host_.reactions(); }
  std::vector<RigidTransform> bodies(const std::vector<RigidTransform>& bones) const override;
  std::int64_t lost_points() const override;
  double body_energy() const override;
  std::vector<float> motion(const std::vector<std::vector<RigidTransform>>& bones) const override;
  void add_energies(const std::vector<double> (&u)[3], const std::vector<RigidTransform>& bones, bool open,
                    Vectors& forces, EnergyLedger& ledger) override;

private:
  using Vector = HostContact::Vector;
  using PushedMotion = HostContact::PushedMotion;

  void add_pushed(const Model& model);
  void add_points(const Model& model);
  void add_to_patches(const VoxelPatches& patches);
  void add_to_strips(const Model& model, const std::vector<std::uint32_t>& device_node);

  const Model& model_;
  HostContact host_;
  // first point of each voxel among the host's points; the last entry is their number
  std::vector<std::uint32_t> first_point_;
  std::vector<std::uint32_t> point_;  // index on the host of each point on the device
  std::vector<std::uint32_t> copy_;   // index on the device of one copy of each of the host's points
  std::array<double, 3> far_corner_;  // corner of the grid opposite to its origin [m]
  DeviceFields fields_;
  std::vector<ContactBody> host_bodies_;
  DeviceArray<ContactBody> bodies_;
  DeviceArray<ContactPoint> points_;
  DeviceArray<BoundVoxel> voxels_;
  DeviceArray<PatchContact> patches_;
  DeviceArray<uint4> corners_;
  DeviceBoundPoints bound_;  // used by strips
  DeviceArray<float4> watched_, samples_, clearances_;
  DeviceArray<float4> grips_, forces_, arms_;
  DeviceArray<ContactHold> holds_;
  // Of bodies that are pushed; see PushedBodies.
  std::vector<PushedBody> host_pushed_;
  DeviceArray<PushedBody> pushed_;
  DeviceArray<PushedMotion> motions_;
  DeviceArray<Vector> reactions_;
};

}  // namespace cuda
}  // namespace frontalis
