#pragma once

#include "cuda/backend/device_attachment.hpp"
#include "cuda/backend/device_contacts.hpp"
#include "cuda/backend/device_part.hpp"
#include "cuda/backend/device_loads.hpp"
#include "cuda/backend/device_viscosity.hpp"
#include "solver/stepping/discretisation.hpp"
#include "cuda/kernels/step_kernel.hpp"

#include <memory>
#include <vector>

namespace frontalis
{
namespace cuda
{

/// Returns StepArguments::fibre_muscle: one word per fibre.
std::vector<std::uint32_t> muscle_words(const Model& model, EffectSet running);

/// The effects that a model's kernels must compute because of its voxels and of friction, in strips or in patches.
Effects effects_of(const Model& model, const Discretisation& discretisation, bool in_strips);

/// Choice between patches, if they fit into shared memory, and strips.
struct CutChoice
{
  PatchSettings patches{ 0, 0 };  ///< number of turns (patches per block) to try first; 0 turns: use strips
  std::size_t patch_bytes = 0;    ///< shared memory available for the patches of a block
  StripSettings strips;
  std::size_t most_strips = 0;  ///< number of strips that the device runs at the same time
  int most_planes = 0;          ///< strips may be lengthened to this number of planes to be about `most_strips`
};

/// The patches or strips of a model.
struct VoxelCut
{
  VoxelCut(const Model& model, const CutChoice& choice);

  std::unique_ptr<VoxelPatches> patches;
  PartRoom part_room;                   ///< shared memory and threads for parts, if the model is cut into patches
  std::unique_ptr<VoxelStrips> strips;  ///< null if the model is cut into patches
  /// Whether a kernel before each step computes the stress of fibres and of laws other than neo-Hookean. This is done
  /// with strips only, if there are such laws or if fibres fill few of the lanes.
  bool stress_apart = false;

  std::vector<std::uint32_t>& device_node() { return patches ? patches->device_node : strips->device_node; }
  /// For each entry of the partition, 1 + the index of its model voxel, or 0 if the entry is empty.
  std::vector<std::uint32_t> voxel_at() const;
};

/// A model in device memory, without the motion of its nodes.
class DeviceModel
{
public:
  /// Throws BackendUnavailable if the memory is too small. Before anything is allocated, the sum of the largest arrays
  /// is compared with the free memory; the message has both numbers of bytes.
  DeviceModel(const Model& model, const Discretisation& discretisation, const CutChoice& cut);

  /// Returns step arguments with all constant data. `idle_parts`: include the data of parts that are switched off.
  StepArguments arguments(bool idle_parts = false) const;
  /// Computes only these effects from now on. Arrays keep their addresses and sizes.
  void run(const Model& model, const Discretisation& discretisation, EffectSet running);
  void list_arrays(Effect of_fibres, ArrayList& list);
  /// Sets all effects to their state at rest.
  void reset();

  Effects effects() const { return effects_; }
  /// How the step kernel is launched, except for the number of blocks.
  const StepLaunch& launch() const { return launch_; }
  /// The launch with all effects of parts(), including those that are switched off.
  StepLaunch launch_with_parts() const;
  std::size_t patches() const { return patches_.size(); }
  std::size_t strips() const { return strips_.size(); }
  double filled() const { return filled_; }                      ///< VoxelStrips::filled()
  std::size_t nodes() const { return device_node_.size() + 1; }  ///< including the placeholder, node 0
  const std::vector<std::uint32_t>& device_node() const { return device_node_; }
  const std::vector<std::uint32_t>& palette_of_voxel() const { return palette_of_voxel_; }
  /// Model nodes that never move.
  const std::vector<std::uint32_t>& still_nodes() const { return still_nodes_; }
  const DeviceContacts& contacts() const { return contacts_; }
  /// Contact and shells, if the model has them.
  const std::vector<std::unique_ptr<DevicePart>>& parts() const { return parts_; }
  std::vector<DevicePart*> running_parts() const;
  DeviceLoads& loads() { return loads_; }
  const DeviceLoads& loads() const { return loads_; }
  /// Inverse masses in the frequency bound; null if they are those of the nodes.
  float* inverse_bound_masses() const { return mobility_.data(); }
  /// The same, limited by StepBackend::measure_growth(); null if the model is not assembled.
  float* limited_mobility() const { return limited_mobility_.data(); }
  /// Takes the masses of attached nodes and their masters from the inverse masses in `u`.
  void take_masses(const float4* u, cudaStream_t stream) const { attachment_.take_masses(u, stream); }
  DeviceViscosity& viscosity() { return viscosity_; }
  const DeviceViscosity& viscosity() const { return viscosity_; }

private:
  DeviceModel(const Model& model, const Discretisation& discretisation, VoxelCut&& cut);
  std::vector<std::uint32_t> add_palette(const Model& model, const Discretisation& discretisation,
                                         const std::vector<std::uint32_t>& added);
  void add_fibres(const Model& model, const Discretisation& discretisation);
  std::vector<NodeTask> add_tasks(const Model& model);
  void add_strips(VoxelStrips& strips);
  void add_added_voxels(const Model& model, const std::vector<std::uint32_t>& added);
  void add_patches(const Model& model, const VoxelPatches& patches, const PartRoom& for_parts,
                   const std::vector<NodeTask>& tasks, const std::vector<std::uint32_t>& palette_entry);
  void run_fibres(const Model& model, const Discretisation& discretisation, EffectSet running);
  void run_tasks(EffectSet running);
  Effects node_part(const std::vector<NodeTask>& tasks) const;
  void choose_effects(EffectSet running);
  void choose_kernel();

  std::vector<EffectPart*> all_parts();

  /// Copies of the arrays with all effects switched on, made when an effect is first switched.
  struct Whole
  {
    std::vector<Strip> strips;
    std::vector<NodeTask> tasks;
    std::vector<std::int32_t> patch_tasks;
  };

  Effects most_effects_;  // all effects of the model
  Effects effects_ = Effects::none;
  StepLaunch launch_{};
  std::vector<std::uint32_t> device_node_;
  std::vector<std::uint32_t> still_nodes_;
  std::vector<std::uint32_t> palette_of_voxel_;
  StepArguments constants_{};
  Whole whole_;

  DeviceArray<Patch> patches_;
  DeviceArray<uint4> patch_corners_, node_voxels_;
  DeviceArray<uint2> patch_properties_;
  DeviceArray<std::uint32_t> halo_;
  DeviceArray<std::int32_t> patch_tasks_;
  DeviceArray<Strip> strips_;
  double filled_ = 1;
  DeviceArray<StripSlot> slots_;
  DeviceArray<float> mobility_, limited_mobility_, stiffness_bounds_;
  DeviceArray<float4> palette_, stabilisation_, centres_, corner_stiffness_;
  DeviceArray<std::uint32_t> law_begin_;
  DeviceArray<LawEntry> laws_;
  DeviceArray<AddedVoxel> added_voxels_;
  DeviceArray<AddedStress> added_stress_;
  DeviceArray<std::uint32_t> fibre_words_, fibre_muscle_;
  DeviceArray<float4> fibres_;
  DeviceArray<NodeTask> tasks_;
  DeviceArray<PrescribedMotion> prescribed_;
  DeviceArray<float4> rigid_;
  DeviceLoads loads_;
  DeviceViscosity viscosity_;
  DeviceContacts contacts_;
  DeviceAttachment attachment_;
  std::vector<std::unique_ptr<DevicePart>> parts_;
};

}  // namespace cuda
}  // namespace frontalis
