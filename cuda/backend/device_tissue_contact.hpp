#pragma once

#include "cuda/backend/device_bound_points.hpp"
#include "cuda/backend/device_part.hpp"
#include "cuda/backend/tissue_contact_tables.hpp"

namespace frontalis
{
namespace cuda
{

/// Contact of tissue with itself in device memory. Kernels place the vertices before each step, find the forces of
/// pairs of a vertex and a triangle, and change the velocities of nodes. When vertices have moved so far that a vertex
/// could touch a triangle with which it forms no pair, the same kernels also search for new pairs, in the course of two
/// steps.
class DeviceTissueContact : public DevicePart
{
public:
  DeviceTissueContact(const Model& model, const Discretisation& discretisation,
                      const std::vector<std::uint32_t>& device_node);

  bool idle() const override { return !runs_ || tables_.vertices.empty(); }
  Effects effects() const override { return Effects::none; }
  bool has_kernels() const override { return true; }
  void describe(StepArguments& /*g*/) const override {}
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
  DeviceBoundPoints points_;
  DeviceArray<TouchVertex> vertices_;
  DeviceArray<TouchTriangle> triangles_;
  DeviceArray<std::int32_t> joined_begin_, joined_sources_;
  DeviceArray<float4> moved_, normal_, change_, searched_, dual_;
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
