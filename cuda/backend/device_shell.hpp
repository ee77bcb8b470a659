#pragma once

#include "cuda/backend/device_bound_points.hpp"
#include "cuda/backend/device_part.hpp"
#include "frontalis/solver/shell_mesh.hpp"

#include <functional>

namespace frontalis
{
namespace cuda
{

/// For each voxel of the model, those that carry vertices of the triangles around its own vertices.
std::vector<std::vector<std::int32_t>> voxels_beside(const Model& model, const ShellMesh& mesh);

/// The arrays of ShellArguments on the host.
struct ShellTables
{
  /// `cut` null: for strips, one patch of everything, whose corners are device nodes. `device_node`: of each model
  /// node.
  ShellTables(const Model& model, const ShellMesh& mesh, const VoxelPatches* cut,
              const std::vector<std::uint32_t>& device_node);

  std::vector<PatchShell> patches;
  std::vector<uint4> corners;
  std::vector<float4> coordinates;
  std::vector<uint2> sums;
  std::vector<std::uint32_t> terms;
  std::vector<std::uint32_t> triangles;  ///< of the mesh
  std::vector<float4> words;             ///< ShellArguments::triangles
  std::vector<BoundVoxel> voxels;
  std::uint32_t most_words = 0, most_triangles = 0;  ///< per patch: see PatchRoom

private:
  using Voxels = std::vector<std::uint32_t>;
  using Around = std::vector<std::vector<std::uint32_t>>;
  /// `around`: triangles around the vertices of each voxel. `of_patch`: its voxels. `place`: of a node in the patch.
  void add(const Model& model, const ShellMesh& mesh, const Around& around, const Voxels& of_patch,
           const std::function<std::uint32_t(std::int32_t node)>& place);
  void add_triangle(const ShellMesh& mesh, std::uint32_t triangle, const std::vector<std::int32_t>& number);
  void pack(const ShellMesh& mesh);

  std::vector<std::array<std::uint32_t, 6>> vertices_;  // of each triangle, in its patch
};

/// Layers that are shells, in device memory.
class DeviceShell : public DevicePart
{
public:
  DeviceShell(const Model& model, const VoxelCut& cut, const std::vector<std::uint32_t>& device_node);

  bool idle() const override { return !runs_; }
  Effects effects() const override { return of_nodes | Effects::contact | Effects::shell; }
  void describe(StepArguments& g) const override;
  void list_arrays(ArrayList& list) override;
  void run(EffectSet running) override { runs_ = running.has(Effect::shell); }
  void reset() override {}
  void find_pushes(const StepArguments& g, int step, cudaStream_t stream) const override;
  BoundPoints points() const override { return points_.view(); }
  void add_energies(const std::vector<double> (&u)[3], const std::vector<RigidTransform>& bones, bool open,
                    Vectors& forces, EnergyLedger& ledger) override;

private:
  const Model& model_;
  ShellMesh mesh_;
  bool runs_ = true;
  DeviceArray<PatchShell> patches_;
  DeviceArray<uint4> corners_;
  DeviceArray<float4> coordinates_, words_;
  DeviceArray<uint2> sums_;
  DeviceArray<std::uint32_t> terms_;
  DeviceArray<BoundVoxel> voxels_;
  // in strips
  PatchShell all_{};
  DeviceBoundPoints points_;
  DeviceArray<float4> moved_;
  DeviceArray<float> forces_;
};

}  // namespace cuda
}  // namespace frontalis
