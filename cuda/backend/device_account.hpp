#pragma once

#include "cuda/backend/device_memory.hpp"
#include "cuda/backend/device_model.hpp"
#include "solver/energy/energy_account.hpp"

namespace frontalis
{
namespace cuda
{

/// Work done since the account was opened, for the energy ledger. It is kept as partial sums in device memory, which
/// the host adds up on request.
class DeviceAccount
{
public:
  DeviceAccount(const Model& model, DeviceModel& device);

  /// Sets the arrays in which a step stores velocities for the account.
  void describe(StepArguments& g) const;
  /// Starts a new account at displacements `u` with the activations at the end of g's plan.
  void open(const StepArguments& g, const float4* u, cudaStream_t stream);
  /// Adds the work that fibres have done since the previous call, up to displacements `u`.
  void measure(const StepArguments& g, const float4* u, int step, cudaStream_t stream);
  /// Called before and after each step. g.first selects the present displacements, which are those before the step in
  /// before_step() and those after the step in after_step().
  void before_step(const StepArguments& g, int step, cudaStream_t stream);
  void after_step(const StepArguments& g, double damping, int step, cudaStream_t stream);
  /// Returns all work except that of viscous stresses. The stream must be idle.
  Work work() const;
  void list_arrays(Effect of_fibres, ArrayList& list);

private:
  FibreVoxels fibres() const;

  DeviceArray<double> damping_, constraint_, beside_, friction_, load_, fibre_work_;
  DeviceArray<float2> memory_;
  DeviceArray<float> before_[3], free_[3];
  DeviceArray<std::uint32_t> loaded_;
  DeviceArray<FibreVoxel> fibre_voxels_;
};

}  // namespace cuda
}  // namespace frontalis
