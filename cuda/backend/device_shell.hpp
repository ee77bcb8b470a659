#pragma once

#include "cuda/backend/device_bound_points.hpp"
#include "cuda/backend/device_part.hpp"
#include "frontalis/solver/shell_mesh.hpp"

namespace frontalis
{
namespace cuda
{

/// For each voxel of the model, the voxels that shell triangles link to it: those that hold any vertex of a triangle
/// with a vertex in this voxel.
std::vector<std::vector<std::int32_t>> voxels_beside(const Model& model, const ShellMesh& mesh);

/// The shells of each patch, on the host.
class ShellTables
{
public:
  /// `device_node`: device node of each model node.
  ShellTables(const Model& model, const ShellMesh& mesh, const VoxelPatches& cut,
              const std::vector<std::uint32_t>& device_node);

  /// Adds the shared memory and threads that the shells need in a block. `most_voxels`: see VoxelPatches.
  void add_room(std::uint32_t most_voxels, PartRoom& all) const;

  std::vector<PatchShell> patches;
  std::vector<uint4> tables;

private:
  using Around = std::vector<std::vector<std::uint32_t>>;
  void add(const Model& model, const ShellMesh& mesh, const Around& around, const VoxelPatches& cut, std::size_t index,
           const std::vector<std::uint32_t>& device_node);

  std::uint32_t blocks_;
  bool fits_indices_ = true;
};

/// Shells of a model in device memory.
class DeviceShell : public DevicePart
{
public:
  DeviceShell(const Model& model, const VoxelCut& cut, const std::vector<std::uint32_t>& device_node);

  bool idle() const override { return !runs_; }
  Effects effects() const override { return of_nodes | Effects::shell; }
  void describe(StepArguments& g) const override;
  void list_arrays(ArrayList& list) override;
  void run(EffectSet running) override { runs_ = running.has(Effect::shell); }
  void reset() override {}
  void find_pushes(const StepArguments& g, int step, cudaStream_t stream) const override;
  void push(const StepArguments& g, float factor, float* const (&v)[3], cudaStream_t stream) const override
  {
    points_.push(g, factor, v, stream);
  }
  void add_energies(const std::vector<double> (&u)[3], const std::vector<RigidTransform>& bones, bool open,
                    Vectors& forces, EnergyLedger& ledger) override;

private:
  void add_to_strips(const std::vector<std::uint32_t>& device_node);

  const Model& model_;
  ShellMesh mesh_;
  bool runs_ = true;
  DeviceArray<PatchShell> patches_;
  DeviceArray<uint4> tables_;
  // used by strips:
  DeviceBoundPoints points_;
  DeviceArray<float4> words_, moved_;
  DeviceArray<uint2> sums_;
  DeviceArray<std::uint32_t> terms_;
  DeviceArray<float> forces_;
};

}  // namespace cuda
}  // namespace frontalis
