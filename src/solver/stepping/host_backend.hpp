#pragma once

#include "solver/stepping/effect_parts.hpp"
#include "solver/stepping/highest_frequency_search.hpp"
#include "solver/stepping/step_backend.hpp"

#include <algorithm>

namespace frontalis
{

/// Relaxed part of the stresses of viscous voxels, stored in the order of a backend.
template <class T>
class RelaxedStresses : public EffectPart
{
public:
  std::vector<T> values;

  bool relax() const { return runs_ && !values.empty(); }  ///< whether there are stresses to relax
  void list_arrays(ArrayList& list) override { list.add_state(Effect::viscosity, "relaxed stresses", values); }
  void run(EffectSet running) override
  {
    runs_ = running.has(Effect::viscosity);
    if (!runs_)
      reset();
  }
  void reset() override { std::fill(values.begin(), values.end(), T{}); }

private:
  bool runs_ = true;
};

/// Base of the backends that run in host memory: nodal motion, loads, constraints, the account of energies and
/// snapshots. Real is the number type of the motion, Relaxed the entry type of RelaxedStresses.
template <class Real, class Relaxed>
class HostBackend : public StepBackend
{
public:
  void list_arrays(ArrayList& list) override;
  void effects_switched() override;
  void get(NodalField field, NodalVectors& out) const override;
  void set(NodalField field, const NodalVectors& in) override;
  void save(std::unique_ptr<BackendState>& to) override;
  void restore(const BackendState& from) override;
  void add_energies(bool open, NodalVectors& forces, EnergyLedger& ledger) override;
  std::vector<Reaction> reactions() const override;
  std::vector<RigidTransform> bodies() const override;
  std::int64_t lost_points() const override;
  double body_energy() const override;
  void internal_forces(NodalVectors& out) override;
  double highest_frequency_squared() override;
  std::vector<FoundMode> modes_above(double frequency_squared) override
  {
    return search_->modes_above(frequency_squared);
  }
  void masses_changed(const std::vector<std::int32_t>& nodes) override;
  void skin(SkinState& out) override;

protected:
  using Components = std::array<std::vector<Real>, 3>;

  /// `padding`: number of entries of the motion beyond the last node.
  HostBackend(const BackendInput& input, std::size_t padding, const PartKernels<Real>& kernels);

  virtual void rest();
  /// Square of the largest speed of the share's nodes [m2/s2]; NaN if one is not finite.
  Real fastest_squared(const NodeShare& share) const;
  static std::array<const Real*, 3> pointers(const Components& c)
  {
    return { { c[0].data(), c[1].data(), c[2].data() } };
  }
  void interleave(const Components& in, NodalVectors& out) const;
  /// Inverse of interleave(); the components may have more entries than there are nodes.
  static void separate(const NodalVectors& in, Components& out);

  /// Runs task(share) on every thread of the backend. Inside the task, barrier() waits for all threads.
  virtual void on_all_threads(const std::function<void(const NodeShare&)>& task) = 0;
  virtual void barrier() = 0;
  /// First node of each plane, and the number of all nodes.
  virtual std::vector<std::int32_t> first_nodes() const = 0;
  /// Finds the internal forces [N] at displacements u on the share's nodes. found_forces() returns them.
  virtual void find_forces(const NodeShare& share, const Components& u) = 0;
  virtual const Components& found_forces() const = 0;

  /// The parts of effects that are not idle.
  std::vector<NodePart<Real>*> active_parts() const;

  Components u_, v_;
  RelaxedStresses<Relaxed> relaxed_;
  std::unique_ptr<EnergyAccount<Real>> account_;  // null without a ledger
  std::vector<float> mobility_;  // by which the bounds of a node's voxels are multiplied: mobility(), limit_mobility()

private:
  std::vector<std::unique_ptr<NodePart<Real>>> parts_;
  std::unique_ptr<HighestFrequencySearch<Real>> search_;  // null until the first search
};

}  // namespace frontalis
