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

/// Whether the parts of a model run in strips only: bodies that are pushed do.
bool need_strips(const Model& model);

/// The part of the GPU backend for an effect whose forces act on points that are bound to voxels, such as contact. Host
/// backends have NodePart for this. With strips, kernels find the forces before each step. With patches, the patch
/// kernel finds them within its steps, unless has_kernels() is true.
class DevicePart : public EffectPart
{
public:
  using Vectors = std::vector<std::array<double, 3>>;

  virtual bool idle() const = 0;
  /// Effects that the patch kernel must compute.
  virtual Effects effects() const = 0;
  /// Sets the members of `g` that the part's kernels read.
  virtual void describe(StepArguments& g) const = 0;

  /// Returns the motion of bodies in the steps of a plan: the entries of ContactArguments::poses, then those of
  /// PushedBodies::held_at and of ContactArguments::ways. Empty if there are no bodies. `bones`: poses of the bones at
  /// the start of each step.
  virtual std::vector<float> motion(const std::vector<std::vector<RigidTransform>>& /*bones*/) const { return {}; }

  /// Called before the steps of a plan.
  virtual void prepare(const StepArguments& /*g*/, int /*steps*/, cudaStream_t /*stream*/) const {}
  /// Whether the functions for strips are used for patches as well. Each step is then a launch of its own. `stays`:
  /// whether patches could make many steps per launch otherwise.
  virtual bool has_kernels(bool /*stays*/) const { return false; }
  // Functions for strips:
  /// Number of blocks of the kernel that finds added stress which can do what find_pushes() does; 0: they cannot.
  virtual std::uint32_t blocks_beside() const { return 0; }
  /// Finds the forces on points at the start of a step. Not called if the kernel of blocks_beside() did so.
  virtual void find_pushes(const StepArguments& g, int step, cudaStream_t stream) const = 0;
  /// Passes the forces of find_pushes() on to nodes, as launch_push_nodes() does.
  virtual void push(const StepArguments& g, float factor, float* const (&v)[3], cudaStream_t stream) const = 0;

  // Functions that need an idle stream:
  /// Passes the latest step on to the host's account. Called after each step if energies are requested.
  virtual void follow(const ConstraintStep& /*step*/) {}
  virtual std::vector<Reaction> reactions() const { return {}; }
  /// See NodePart::bodies. follow() need not have been called.
  virtual std::vector<RigidTransform> bodies(const std::vector<RigidTransform>& /*bones*/) const { return {}; }
  /// See NodePart. follow() need not have been called.
  virtual std::int64_t lost_points() const { return 0; }
  virtual double body_energy() const { return 0; }
  /// See NodePart::add_energies.
  virtual void add_energies(const std::vector<double> (&u)[3], const std::vector<RigidTransform>& bones, bool open,
                            Vectors& forces, EnergyLedger& ledger) = 0;
};

/// The parts for the effects that the model has. `device_node`: device node of each model node; cut.device_node() is
/// empty when this function is called.
std::vector<std::unique_ptr<DevicePart>> device_parts(const Model& model, const Discretisation& discretisation,
                                                      const VoxelCut& cut,
                                                      const std::vector<std::uint32_t>& device_node);

/// Shared memory and threads that parts need in a block of patches.
struct PartRoom
{
  PatchRoom room{};
  std::uint32_t threads = 0;  ///< number of threads with work other than that of a patch's voxels and nodes; 0: none
  std::uint32_t triangle_words = 0;  ///< to be added to PatchRoom::table_words if shared memory holds the triangles
  bool fits_indices = true;          ///< whether indices of 16 bits suffice
};
PartRoom room_for_parts(const Model& model, const VoxelPatches& patches, const std::vector<std::uint32_t>& device_node);

/// What the parts of a model require of its patches.
BoundWork bound_work(const Model& model);

}  // namespace cuda
}  // namespace frontalis
