#pragma once

#include "frontalis/solver/solver.hpp"

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace frontalis
{

/// Findings of a check of the motion.
enum class Instability
{
  none,
  not_finite,  ///< a displacement is NaN or Inf
  energy,      ///< more energy than muscles, loads and bones can have supplied, or than the ledger explains
  hourglass,   ///< more energy in the hourglass modes alone than the bound of all energy allows
  inverted,    ///< more voxels are inverted than allowed
  time_step,   ///< steps were longer than the critical time step
  past_rim,    ///< a sliding node is far outside its surface's field
  inside_body  ///< tissue is deeper inside of a body than the body's field reaches
};

/// The finding in words that complete the sentence "the motion is unstable: ".
std::string words_for(Instability instability);

struct GuardSettings
{
  /// steps between two checks, up to twice as many if the time step falls meanwhile; 0: Solver::steps_per_check
  int interval = 0;
  double slower = 0.5;  ///< factor on the time step after a finding, applied once per try
  int recovery = 4;     ///< number of checks without a finding before the full time step is used again
  int tries = 3;        ///< failed tries in a row after which the motion is stopped
  /// fraction of voxels that may be inverted (J <= 0); more are allowed if the last good check had more
  double inverted_share = 0.05;
  bool ledger = false;  ///< judge energy by the imbalance of the ledger; needs SolverSettings::ledger
};

/// Counts of a guard's actions since it was made.
struct GuardCounts
{
  std::int64_t checks = 0;
  std::int64_t rollbacks = 0;
  Instability latest = Instability::none;  ///< finding of the latest rollback
  double seconds = 0;                      ///< wall seconds spent in checks and snapshots
};

/// Describes why a motion was stopped.
struct InstabilityReport
{
  Instability kind = Instability::none;
  double time = 0;                    ///< simulated time of the finding [s]
  std::int32_t voxel = -1;            ///< the voxel where the instability begins
  double jacobian = 1;                ///< J of this voxel
  std::array<double, 3> scene{};      ///< centre of this voxel at rest, scene frame [m]
  std::array<double, 3> face{};       ///< the same point in the face frame [m]
  std::vector<std::string> material;  ///< materials of this voxel, the one with the largest fraction first
  std::vector<std::string> muscle;    ///< muscles with fibres in this voxel, the one with the highest tension first
  std::string effect;                 ///< name of the effect that is most likely the cause
  std::string advice;                 ///< what to change
  std::string text() const;           ///< the whole report in two or three sentences
};

/// Thrown when the motion was stopped. The solver is then at the latest good state or, if the last try passed a check
/// before it failed, at the good state before that check.
class Unstable : public Error
{
public:
  explicit Unstable(const InstabilityReport& why) : Error(why.text()), report(why) {}
  InstabilityReport report;
};

/// Watches a solver's motion. At a fixed interval of steps, and at the end of a part of a motion in which
/// the time step has fallen to half, it looks for signs of instability. If there are none it
/// keeps a snapshot; otherwise it goes back to the last good snapshot and takes shorter steps for a while.
///
/// Energy is judged by a bound if there is no ledger. Let E be the kinetic, internal and hourglass energy at the last
/// good check, with the energy of bodies that are pushed. At a time t later the energy may be at most twice
/// (sqrt(E + W) + t sqrt(sum of f^2 / (2 m)))^2. Here f is gravity and surface loads on a node of mass m, or the force
/// on a pushed body of this mass, and W is the sum of
/// - the energy of a strain of 1e-4 everywhere, and what shells store at rest;
/// - the work that fibres can do: active tension times volume times 1.2, the range of stretch in which they pull, plus
/// 0.3 times tension times volume if they have a passive part;
/// - four times the bound of the stiffness of the voxels at bones and prescribed nodes times d^2, where d is the length
/// of the paths of these bones and nodes in the time t, and half of a pushed body's spring times d^2 of its bone;
/// - the energy that viscous stresses can give back.
class Guard
{
public:
  /// As long as the guard exists, advance the solver only through it. Throws Error if settings are out of range.
  explicit Guard(Solver& solver, std::shared_ptr<const Model> model, const GuardSettings& settings = {});
  ~Guard();
  Guard(const Guard&) = delete;
  Guard& operator=(const Guard&) = delete;

  /// Like Solver::advance, but in parts with checks between them. After a rollback, controls change linearly from those
  /// of the snapshot to `target`. Throws Error as Solver::advance does; throws Unstable, with a good state restored,
  /// when `tries` tries in a row have failed. `go_on` is also called between parts, and in the search for the origin
  /// of an instability, which it ends too: Unstable is then not thrown. A motion that it has ended is in a good state.
  /// It may throw; then only Solver::reset() and restart() are of use.
  bool advance(double seconds, const Controls& target, const std::function<bool()>& go_on = {});
  /// Like advance(), but the state at the end has passed a check too, so that it may be shown. If this check finds a
  /// fault, the motion since the latest good state is repeated.
  bool advance_checked(double seconds, const Controls& target, const std::function<bool()>& go_on = {});
  /// Checks the present state and returns whether it is good. After a finding it restores a good state, or throws
  /// Unstable. `go_on`: as of advance().
  bool check(const std::function<bool()>& go_on = {});
  /// Like Solver::settle, with all checks of advance() but the check of the ledger, because settling opens a new
  /// ledger. Throws the errors of Solver::settle and of advance().
  Equilibrium settle(const Controls& target, double tolerance, double seconds,
                     const std::function<bool(const Equilibrium&)>& go_on = {});
  /// Accepts the present state as good without a check. Call it after reset(), or after displacements were set.
  void restart();

  const GuardCounts& counts() const;
  const Monitor& latest() const;  ///< values at the latest check without a finding

private:
  struct Implementation;
  std::unique_ptr<Implementation> self_;
};

}  // namespace frontalis
