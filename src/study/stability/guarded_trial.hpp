#pragma once

#include "frontalis/solver/guard.hpp"
#include "frontalis/study/stability.hpp"
#include "frontalis/study/voxel_model.hpp"

#include <memory>
#include <string>
#include <vector>

namespace frontalis
{

class CaseFile;

/// A motion under the guard whose energies, worst voxel and hourglass share are recorded in a Trial.
class GuardedTrial
{
public:
  GuardedTrial(const StabilitySettings& settings, Trial& trial, std::shared_ptr<const Model> model, bool ledger = true,
               const GuardSettings& guard = {});
  GuardedTrial(const StabilitySettings& settings, Trial& trial, const Model& model, bool ledger = true)
      : GuardedTrial(settings, trial, std::make_shared<const Model>(model), ledger)
  {
  }
  GuardedTrial(const GuardedTrial&) = delete;
  GuardedTrial& operator=(const GuardedTrial&) = delete;
  ~GuardedTrial();

  Solver& solver() { return *solver_; }
  const Model& model() const { return *model_; }

  /// Controls with every muscle at an activation and every bone at a pose.
  Controls controls(float activation = 0, const RigidTransform& pose = {}) const;

  /// Advances in equal parts and records energies after each.
  void advance(double seconds, const Controls& target, int looks = 1);
  struct Phase
  {
    double seconds;
    Controls target;
    int looks;
  };
  /// Plays phases, plots them and then releases the model for a while (the case's in_the_end). Checks that energy was
  /// explained throughout to a share (bounds.energy) and that no node is farther from its rest than bounds.left.
  void play_and_release(const std::vector<Phase>& phases, const std::string& of, const CaseFile& file,
                        const std::string& picture, const std::string& title);
  /// Like Solver::settle(). Throws Error if no equilibrium is reached within `seconds` of simulated time.
  void settle(const Controls& target, double tolerance, double seconds);
  /// Plays a motion that the guard may stop. Where it does, the trial gets the report, and the state is checked to be
  /// good.
  void hold_or_stop(const std::function<void()>& play);
  /// Sets displacements [m] and, unless empty, velocities [m/s]; the ledger opens anew.
  void set(const Vectors& displacements, const Vectors& velocities = {});

  Vectors displacements() const;
  const Monitor& monitor() const { return monitor_; }       ///< when they were recorded last
  const EnergyLedger& energies() const { return ledger_; }  ///< when they were recorded last

  /// Checks that the imbalance of the ledger stayed within the case's bounds.energy of its largest term, and plots the
  /// motion to `picture` if that is not empty.
  void check_balance(const CaseFile& file, const std::string& of, const std::string& picture = {},
                     const std::string& title = {});
  /// Energies over time and the smallest J, as a picture.
  void plot(const std::string& file, const std::string& title);

private:
  struct Moment
  {
    double time, kinetic, stored, unexplained, jacobian;
  };

  void record();

  const StabilitySettings& settings_;
  Trial& trial_;
  std::shared_ptr<const Model> model_;
  std::unique_ptr<Solver> solver_;
  std::unique_ptr<Guard> guard_;
  bool wants_ledger_;
  Monitor monitor_;
  EnergyLedger ledger_;
  // [J]; kept here, since the guard may take the ledger back to an earlier state
  double worst_imbalance_ = 0, most_hourglass_ = 0, largest_ = 0;
  std::vector<Moment> moments_;
};

}  // namespace frontalis
