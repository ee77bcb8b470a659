#pragma once

#include "cuda/backend/device_memory.hpp"
#include "solver/stepping/discretisation.hpp"
#include "cuda/kernels/voxel_kernels.hpp"

#include <vector>

namespace frontalis
{
namespace cuda
{

/// Relaxed stresses of viscous voxels in device memory, and the kernel that updates them.
class DeviceViscosity : public EffectPart
{
public:
  /// `voxel_at`: 1 + the index of the model voxel at each place in the device's order of voxels, 0 if the place is
  /// empty. `apart`: whether each patch that has a copy of a voxel has viscous stresses of its own for it, so that no
  /// patch waits for another.
  DeviceViscosity(const Model& model, const Discretisation& discretisation,
                  const std::vector<std::uint32_t>& device_node, const std::vector<std::uint32_t>& voxel_at,
                  bool apart);

  bool empty() const { return voxels_.size() == 0; }
  bool idle() const { return empty() || !runs_; }
  void list_arrays(ArrayList& list) override;
  /// While viscosity is switched off, its arrays are neither read nor updated.
  void run(EffectSet running) override;
  /// Sets the members of `g` that describe viscosity.
  void describe(StepArguments& g) const;
  /// Stores the palette entries of voxels. Call it when they are known.
  void set_palette(const std::vector<std::uint32_t>& entry_of_voxel);
  /// Sets the relaxed stresses and the account of their work to zero.
  void reset() override;
  void reset_account() { account_.clear(); }
  /// Relaxes stresses by `elapsed` [s] towards those at `u`. `u_before`: displacements one step earlier, used for the
  /// account only.
  void relax(const StepArguments& g, const float4* u, const float4* u_before, double elapsed, cudaStream_t stream);
  /// Starts an account of the work of viscous stresses.
  void keep_account();
  /// Work that viscous stresses have absorbed since the account was opened [J].
  double work() const;

private:
  ViscousVoxels view() const;

  int terms_ = 0;
  bool runs_ = true;
  std::vector<std::uint32_t> voxel_;  // model voxel of each viscous voxel
  std::vector<char> counted_;         // whether the account counts the entry: only one copy of a voxel is counted
  std::vector<ViscousVoxel> host_;    // copies on the host until the palette entries are known
  DeviceArray<ViscousVoxel> voxels_;
  DeviceArray<std::uint32_t> words_;
  DeviceArray<float4> properties_;
  DeviceArray<float> relaxed_;
  DeviceArray<double> account_;
};

}  // namespace cuda
}  // namespace frontalis
