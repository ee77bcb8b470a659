#pragma once

#include "frontalis/solver/solver.hpp"

#include <memory>
#include <string>
#include <utility>

namespace frontalis
{
namespace test
{

/// Forwards all calls to another solver. A test overrides the calls that it wants to change.
class WrappedSolver : public Solver
{
public:
  using Vectors = std::vector<std::array<double, 3>>;

  explicit WrappedSolver(std::unique_ptr<Solver> solver) : solver_(std::move(solver)) {}

  void reset() override { solver_->reset(); }
  bool advance(double seconds, const Controls& target, const std::function<bool()>& go_on) override
  {
    return solver_->advance(seconds, target, go_on);
  }
  void check(double seconds, const Controls& target) const override { solver_->check(seconds, target); }
  Equilibrium settle(const Controls& target, double tolerance, double seconds,
                     const std::function<bool(const Equilibrium&)>& go_on) override
  {
    return solver_->settle(target, tolerance, seconds, go_on);
  }
  void save(std::unique_ptr<Snapshot>& to) override { solver_->save(to); }
  void restore(const Snapshot& snapshot) override { solver_->restore(snapshot); }
  std::string pack() override { return solver_->pack(); }
  void unpack(const std::string& bytes) override { solver_->unpack(bytes); }
  int steps_per_check() const override { return solver_->steps_per_check(); }
  void slow_down(double share) override { solver_->slow_down(share); }
  double time() const override { return solver_->time(); }
  double time_step() const override { return solver_->time_step(); }
  const Controls& controls() const override { return solver_->controls(); }
  const std::vector<float>& activation() const override { return solver_->activation(); }
  EffectSet effects() const override { return solver_->effects(); }
  void switch_effect(Effect effect, bool on) override { solver_->switch_effect(effect, on); }
  std::vector<Allocation> allocations() const override { return solver_->allocations(); }
  void skin(SkinState& out) override { solver_->skin(out); }
  void skin_field(SkinField field, std::vector<float>& out) override { solver_->skin_field(field, out); }
  Monitor monitor() override { return solver_->monitor(); }
  EnergyLedger ledger() override { return solver_->ledger(); }
  Profile profile() const override { return solver_->profile(); }
  void displacements(Vectors& out) const override { solver_->displacements(out); }
  void set_displacements(const Vectors& in) override { solver_->set_displacements(in); }
  void set_velocities(const Vectors& in) override { solver_->set_velocities(in); }
  void internal_forces(Vectors& out) override { solver_->internal_forces(out); }
  std::string description() const override { return solver_->description(); }

private:
  std::unique_ptr<Solver> solver_;
};

}  // namespace test
}  // namespace frontalis
