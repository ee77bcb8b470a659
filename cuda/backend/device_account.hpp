#pragma once

#include "cuda/backend/device_memory.hpp"
#include "cuda/backend/device_model.hpp"
#include "solver/energy/energy_account.hpp"

namespace frontalis
{
namespace cuda
{

/// Work on nodes and of fibres since the account was opened.
struct DeviceBook
{
  DeviceArray<double> damping, constraint, beside, friction, load, fibre_work;
  DeviceArray<float2> memory;

  void assign(const DeviceBook& from, cudaStream_t stream);
  void archive(ByteArchive& archive);
};

/// Sums that work in device memory; the host adds up the parts on request.
class DeviceAccount
{
public:
  DeviceAccount(const Model& model, DeviceModel& device);

  /// Fills in where a step stores velocities for the account.
  void describe(StepArguments& g) const;
  /// Begins anew at displacements u with the activations at the end of g's plan.
  void open(const StepArguments& g, const float4* u, cudaStream_t stream);
  /// Adds the work of fibres since the last call, up to displacements u.
  void look(const StepArguments& g, const float4* u, int step, cudaStream_t stream);
  /// Around each step: g.first is the displacements' buffer before it, after it.
  void before_step(const StepArguments& g, int step, cudaStream_t stream);
  void after_step(const StepArguments& g, double damping, int step, cudaStream_t stream);
  const DeviceBook& book() const { return book_; }
  void restore(const DeviceBook& book, cudaStream_t stream) { book_.assign(book, stream); }
  /// All work but that of viscous stresses; the stream must be idle.
  Work work() const;
  void list_allocations(Effect of_fibres, AllocationList& list) const;

private:
  FibreVoxels fibres() const;

  DeviceBook book_;
  DeviceArray<float> before_[3], free_[3];
  DeviceArray<std::uint32_t> loaded_;
  DeviceArray<FibreVoxel> fibre_voxels_;
};

}  // namespace cuda
}  // namespace frontalis
