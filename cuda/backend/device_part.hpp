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
  virtual bool in_patches() const = 0;
  /// Sets the arguments that steps need.
  virtual void describe(StepArguments& g) const = 0;

  /// Motion of bodies in the steps of a plan, from the bones' poses at the start of each: ContactArguments::poses, then
  /// ways.
  virtual std::vector<float> motion(const std::vector<std::vector<RigidTransform>>& bones) const = 0;

  // for strips
  /// Pushes the nodes before a step.
  virtual void push(const StepArguments& g, int step, cudaStream_t stream) const = 0;
  /// Takes the pushes of the latest step from the velocities `v`.
  virtual void take_back(const StepArguments& g, float* const (&v)[3], cudaStream_t stream) const = 0;
  /// Adds the opposite of the forces that points have as springs to the internal forces in g.u[1 - g.first].
  virtual void add_springs(const StepArguments& g, cudaStream_t stream) const = 0;

  // the stream must be idle
  /// Leaves the latest step to the host's account. Called after each step if energies are asked for.
  virtual void follow(const ConstraintStep& step) = 0;
  virtual std::vector<Reaction> reactions() const = 0;
  /// See NodePart::lost_points. Needs no follow().
  virtual std::int64_t lost_points() const = 0;
  /// See NodePart::add_energies.
  virtual void add_energies(const Vectors& u, const std::vector<RigidTransform>& bones, bool open, Vectors& forces,
                            EnergyLedger& ledger) = 0;
};

/// The part for contact with rigid bodies; null if the model has none.
std::unique_ptr<DevicePart> touching_part(const Model& model, const Discretisation& discretisation, const VoxelCut& cut,
                                          const std::vector<std::uint32_t>& device_node);

/// Most points of contact in a patch.
std::uint32_t most_touching_points(const Model& model, const VoxelPatches& patches);

}  // namespace cuda
}  // namespace frontalis
