#pragma once

#include "cuda/backend/device_memory.hpp"
#include "solver/stepping/discretisation.hpp"
#include "frontalis/byte_archive.hpp"
#include "cuda/kernels/voxel_kernels.hpp"

#include <vector>

namespace frontalis
{
namespace cuda
{

/// Relaxed stresses of viscous voxels in device memory, and the kernel that renews them.
class DeviceViscosity
{
public:
  /// `voxel_at`: 1 + the model voxel at each place of the strips or patches, 0: none. `apart`: a voxel in several
  /// places has stresses of its own in each, so that the patches that compute it need not wait for each other.
  DeviceViscosity(const Model& model, const Discretisation& discretisation,
                  const std::vector<std::uint32_t>& device_node, const std::vector<std::uint32_t>& voxel_at,
                  bool apart);

  bool empty() const { return voxels_.size() == 0; }
  /// Where viscosity is off nothing is read or renewed.
  void run(EffectSet running);
  bool idle() const { return empty() || !runs_; }
  void list_allocations(AllocationList& list) const;
  /// Fills in what a step needs.
  void describe(StepArguments& g) const;
  /// To be called once the voxels' palette entries are known.
  void set_palette(const std::vector<std::uint32_t>& entry_of_voxel);
  /// Relaxed stresses to zero, and the account of their work.
  void reset();
  void reset_account();
  /// Stresses relax by `elapsed` [s] towards those at displacements u; u_before: a step earlier, for the account alone.
  void relax(const StepArguments& g, const float4* u, const float4* u_before, double elapsed, cudaStream_t stream);
  /// Keeps an account of their work from now on.
  void keep_account();
  /// Work that viscous stresses have taken up since the account was opened [J].
  double work() const;

  /// Relaxed stresses and their account, into `to` or back from it.
  struct Kept
  {
    DeviceArray<float> relaxed;
    DeviceArray<double> account;

    void archive(ByteArchive& archive);
  };
  void save(Kept& to, cudaStream_t stream) const;
  void restore(const Kept& from, cudaStream_t stream);

private:
  ViscousVoxels view() const;

  int terms_ = 0;
  bool runs_ = true;
  std::vector<std::uint32_t> voxel_;  // model voxel of each that is kept
  std::vector<char> counted_;         // whether it is the first of its model voxel
  std::vector<ViscousVoxel> host_;    // until palette entries are known
  DeviceArray<ViscousVoxel> voxels_;
  DeviceArray<std::uint32_t> words_;
  DeviceArray<float4> makes_;
  DeviceArray<float> relaxed_;
  DeviceArray<double> account_;
};

}  // namespace cuda
}  // namespace frontalis
