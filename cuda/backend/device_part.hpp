#pragma once

#include "cuda/kernels/step_kernel.hpp"
#include "frontalis/solver/reaction.hpp"
#include "frontalis/solver/solver_state.hpp"
#include "solver/stepping/array_list.hpp"
#include "solver/stepping/constraint_step.hpp"
#include "solver/stepping/discretisation.hpp"

#include <memory>
#include <vector>

namespace frontalis
{
namespace cuda
{

struct VoxelCut;

/// The part of the GPU backend that serves an effect with points that are bound to voxels and push them: what NodePart
/// is to the host backends. Patches find the forces in their steps, strips in kernels before each step.
class DevicePart : public EffectPart
{
public:
  using Vectors = std::vector<std::array<double, 3>>;

  virtual bool idle() const = 0;
  /// What the kernel of patches must compute.
  virtual Effects effects() const = 0;
  /// Sets the arguments that steps need.
  virtual void describe(StepArguments& g) const = 0;

  /// Motion of bodies in the steps of a plan, from the bones' poses at the start of each: ContactArguments::poses, then
  /// ways. Empty: there are no bodies.
  virtual std::vector<float> motion(const std::vector<std::vector<RigidTransform>>& /*bones*/) const { return {}; }

  // for strips
  /// Finds the forces on points at the start of a step and leaves them in points().
  virtual void find_pushes(const StepArguments& g, int step, cudaStream_t stream) const = 0;
  virtual BoundPoints points() const = 0;

  // the stream must be idle
  /// Leaves the latest step to the host's account. Called after each step if energies are asked for.
  virtual void follow(const ConstraintStep& /*step*/) {}
  virtual std::vector<Reaction> reactions() const { return {}; }
  /// See NodePart::lost_points. Needs no follow().
  virtual std::int64_t lost_points() const { return 0; }
  /// See NodePart::add_energies.
  virtual void add_energies(const std::vector<double> (&u)[3], const std::vector<RigidTransform>& bones, bool open,
                            Vectors& forces, EnergyLedger& ledger) = 0;
};

/// The parts of a model, for those effects that it has. `device_node`: of each model node; that of the cut is empty.
std::vector<std::unique_ptr<DevicePart>> device_parts(const Model& model, const Discretisation& discretisation,
                                                      const VoxelCut& cut,
                                                      const std::vector<std::uint32_t>& device_node);

/// Room and threads for them in a block of patches.
struct PartRoom
{
  PatchRoom room{};
  std::uint32_t threads = 0;         ///< that have work besides that of a patch's voxels and nodes; 0: none
  std::uint32_t triangle_words = 0;  ///< to be added to PatchRoom::table_words if triangles are kept
  bool fits_indices = true;          ///< whether indices of 16 bits suffice
};
PartRoom room_for_parts(const Model& model, const VoxelPatches& patches, const std::vector<std::uint32_t>& device_node);

/// What the parts of a model ask of its patches.
BoundWork bound_work(const Model& model);

}  // namespace cuda
}  // namespace frontalis
