#pragma once

#include "cuda/backend/device_bound_points.hpp"
#include "cuda/backend/device_part.hpp"
#include "cuda/backend/tissue_contact_tables.hpp"
#include "cuda/backend/touch_patches.hpp"

namespace frontalis
{
namespace cuda
{

/// Number of vertices in the patch that has most of the vertices that may touch other tissue; 0 if patches cannot find
/// the forces within their steps, because blocks process several patches in turn. Such patches would wait for each
/// other, because they read vertices that other patches place in the same step.
std::uint32_t most_touching_vertices(const Model& model, const VoxelPatches& patches);

/// Contact of tissue with itself in device memory. Before the steps of a plan, kernels search for pairs of a vertex
/// and a triangle if the motion requires it. Patches then find the forces of the pairs within their steps. In strips,
/// and with patches that make one step per launch, kernels before each step place the vertices, find the forces, and
/// change the velocities of nodes.
class DeviceTissueContact : public DevicePart
{
public:
  DeviceTissueContact(const Model& model, const Discretisation& discretisation, const VoxelCut& cut,
                      const std::vector<std::uint32_t>& device_node);

  bool idle() const override { return !runs_ || tables_.vertices.empty(); }
  Effects effects() const override { return in_patches_ ? Effects::touch : Effects::none; }
  bool has_kernels(bool stays) const override { return !(stays && in_patches_); }
  void describe(StepArguments& g) const override { g.touch = all_; }
  void prepare(const StepArguments& g, int steps, cudaStream_t stream) const override;
  void list_arrays(ArrayList& list) override;
  void run(EffectSet running) override;
  void reset() override;
  void find_pushes(const StepArguments& g, int step, cudaStream_t stream) const override;
  void push(const StepArguments& g, float factor, float* const (&v)[3], cudaStream_t stream) const override;
  void add_energies(const std::vector<double> (&u)[3], const std::vector<RigidTransform>& bones, bool open,
                    Vectors& forces, EnergyLedger& ledger) override;

private:
  const Model& model_;
  const std::vector<std::uint32_t> device_node_;
  const TouchTables tables_;
  bool runs_ = true;
  TissueContactArguments all_{};
  std::unique_ptr<DeviceTouchPatches> in_patches_;  // null if patches do not find the forces
  DeviceBoundPoints points_;
  DeviceArray<TouchVertex> vertices_;
  DeviceArray<TouchTriangle> triangles_;
  DeviceArray<std::int32_t> joined_begin_, joined_sources_;
  DeviceArray<float4> moved_, searched_, placed_, normal_, change_, dual_;
  DeviceArray<TouchPair> pairs_;
  DeviceArray<double> lost_;
  DeviceArray<TouchControl> control_;
  DeviceArray<std::int32_t> heads_, next_;
  DeviceArray<TouchSum> sums_;
  DeviceArray<float> stored_;
  std::vector<double> opened_ = std::vector<double>(1, 0);  // sum of lost_ when the account was opened [J]
};

}  // namespace cuda
}  // namespace frontalis
