#pragma once

#include "solver/stepping/attached_nodes.hpp"
#include "solver/stepping/nodal_loads.hpp"
#include "solver/stepping/restricted_nodes.hpp"
#include "solver/stepping/step_backend.hpp"

#include <algorithm>

namespace frontalis
{

/// Stresses that viscous voxels have relaxed, in the order of a backend.
template <class T>
class RelaxedStresses : public EffectPart
{
public:
  std::vector<T> values;

  bool relax() const { return runs_ && !values.empty(); }  ///< whether there is anything to relax
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

/// What the backends in host memory share: nodal motion, loads, constraints, the account of energies and snapshots.
/// Real is the number type of the motion, Relaxed that of RelaxedStresses.
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
  ContactEnergy contact_energy(bool open, NodalVectors& forces) override
  {
    return contact_.energy(pointers(u_).data(), conditions_.bone, open, forces);
  }
  std::vector<Reaction> reactions() const override { return contact_.reactions(); }
  void skin(SkinState& out) override;

protected:
  using Components = std::array<std::vector<Real>, 3>;

  /// `padding`: entries of the motion beyond the last node.
  HostBackend(const BackendInput& input, std::size_t padding, SlideKernel<Real> slide);

  virtual void rest();
  static std::array<const Real*, 3> pointers(const Components& c)
  {
    return { { c[0].data(), c[1].data(), c[2].data() } };
  }
  void interleave(const Components& in, NodalVectors& out) const;
  /// The same back; components may have more entries.
  static void separate(const NodalVectors& in, Components& out);

  Components u_, v_;
  RelaxedStresses<Relaxed> relaxed_;
  RestrictedNodes<Real> restricted_;
  AttachedNodes<Real> attached_;
  NodalLoads loads_;
  BodyContact contact_;
  std::unique_ptr<EnergyAccount<Real>> account_;  // if a ledger was asked for

private:
  std::array<EffectPart*, 5> parts() { return { { &relaxed_, &restricted_, &attached_, &loads_, &contact_ } }; }
};

}  // namespace frontalis
