#pragma once

#include "device_memory.hpp"
#include "device_surface.hpp"
#include "device_viscosity.hpp"
#include "discretisation.hpp"
#include "step_kernel.hpp"

#include <vector>

namespace frontalis
{
namespace cuda
{

/// What a model's voxels need of the kernels.
Effects effects_of(const Model& model, const Discretisation& discretisation);

struct CutChoice
{
  bool bricks = false;
  StripSettings strips;
};

/// A model in device memory: what stays constant while it runs, and the contacts of its sliding nodes.
class DeviceModel
{
public:
  /// Throws Error with the bytes wanted and free where the device has too little memory, before anything is allocated.
  DeviceModel(const Model& model, const Discretisation& discretisation, const CutChoice& cut);

  /// Arguments of a step with all that is constant filled in.
  StepArguments arguments() const;
  /// Contacts as they are at rest.
  void reset_contacts();
  /// What sliding nodes know of their surfaces.
  struct Contacts
  {
    DeviceArray<SlidingContact> sliding;
    DeviceArray<TangentPlane> planes;
  };
  void save(Contacts& to, cudaStream_t stream) const;
  void restore(const Contacts& from, cudaStream_t stream);

  const CutChoice& cut() const { return cut_; }
  Effects effects() const { return effects_; }
  std::size_t strips() const { return strips_.size(); }
  double filled() const { return filled_; }
  std::size_t nodes() const { return device_node_.size() + 1; }  ///< with the place holder
  const std::vector<std::uint32_t>& device_node() const { return device_node_; }
  const std::vector<std::uint32_t>& still_nodes() const { return still_nodes_; }  ///< model nodes
  std::size_t contacts() const { return sliding_.size(); }
  DeviceLoads& loads() { return loads_; }
  DeviceViscosity& viscosity() { return viscosity_; }
  const DeviceViscosity& viscosity() const { return viscosity_; }

private:
  DeviceModel(const Model& model, const Discretisation& discretisation, const CutChoice& cut, VoxelStrips&& strips);
  void add_palette(const Model& model, const Discretisation& discretisation, std::vector<StripSlot>& slots);
  void add_fibres(const Model& model, const Discretisation& discretisation, const VoxelStrips& strips);
  void add_tasks(const Model& model, VoxelStrips& strips);
  void add_brick_tasks(const VoxelStrips& strips, const std::vector<NodeTask>& tasks);
  void add_sliding(const Model& model, std::vector<NodeTask>& task_of);

  CutChoice cut_;
  Effects effects_;
  double filled_;
  std::vector<std::uint32_t> device_node_;
  std::vector<std::uint32_t> still_nodes_;
  StepArguments constants_{};

  DeviceArray<Strip> strips_;
  DeviceArray<StripSlot> slots_;
  DeviceArray<float4> palette_, stabilisation_;
  DeviceArray<std::uint32_t> law_begin_;
  DeviceArray<LawEntry> laws_;
  DeviceArray<std::uint32_t> fibre_words_, fibre_muscle_;
  DeviceArray<float4> fibres_;
  DeviceArray<NodeTask> tasks_;
  DeviceArray<SlidingContact> sliding_;
  DeviceArray<TangentPlane> contact_planes_;
  std::vector<char> glides_;  // contacts
  DeviceArray<std::int32_t> brick_tasks_;
  std::vector<DeviceArray<SurfaceSearch::Box>> boxes_;
  std::vector<DeviceArray<SurfaceSearch::Triangle>> triangles_;
  DeviceArray<PrescribedMotion> prescribed_;
  DeviceArray<RigidMotion> rigid_;
  DeviceLoads loads_;
  DeviceViscosity viscosity_;
};

}  // namespace cuda
}  // namespace frontalis
