#pragma once

#include "frontalis/solver/guard.hpp"
#include "frontalis/solver/rigid_motion.hpp"
#include "frontalis/study/stability.hpp"
#include "frontalis/study/voxel_model.hpp"
#include "study/stability/case_file.hpp"

#include <memory>
#include <string>
#include <vector>

namespace frontalis
{

/// A hard case while it runs: its file, the settings of the run and its result.
struct CaseRun : CaseFile
{
  const StabilitySettings& settings;
  Trial& trial;

  /// The number KEY of the file, or KEY_in_full in long runs.
  double count(const std::string& key) const;
  /// Checks that `found` differs from `expected` by at most bounds.KEY of the file, in the same unit. `what`: name of
  /// the figure.
  void check(const std::string& what, const std::string& unit, double expected, double found, const std::string& key);
  /// Like check(), with the bound in percent of the expected figure.
  void check_relative(const std::string& what, const std::string& unit, double expected, double found,
                      const std::string& key);
};

// Name and function of each case of a family; stability.cpp reads the files of the cases.
using CaseFunctions = std::vector<std::pair<std::string, void (*)(CaseRun&)>>;
CaseFunctions hard_materials();
CaseFunctions hard_shapes();
CaseFunctions hard_muscles();
CaseFunctions hard_faces();
CaseFunctions hard_constraints();
CaseFunctions hard_contacts();
CaseFunctions hard_slits();
CaseFunctions hard_times();

/// A motion under the guard. Its energies, smallest J and hourglass energy are recorded in the case's trial.
class GuardedTrial
{
public:
  GuardedTrial(CaseRun& run, std::shared_ptr<const Model> model, bool ledger = true, const GuardSettings& guard = {});
  GuardedTrial(CaseRun& run, const Model& model, bool ledger = true)
      : GuardedTrial(run, std::make_shared<const Model>(model), ledger)
  {
  }
  GuardedTrial(const GuardedTrial&) = delete;
  GuardedTrial& operator=(const GuardedTrial&) = delete;
  ~GuardedTrial();

  Solver& solver() { return *solver_; }
  const Model& model() const { return *model_; }

  /// Controls with every muscle at an activation and every bone at a pose.
  Controls controls(float activation = 0, const RigidTransform& pose = {}) const;

  struct Phase
  {
    double seconds;
    Controls target;
    int parts = 1;
  };
  /// Changes the controls linearly to the target in equal parts and records energies after each.
  void advance(const Phase& phase);
  /// Advances through phases, plots them and then releases the model for the case's in_the_end [s]. Checks the energy
  /// balance and that no node remains farther than bounds.left from its rest position. `of` names the motion in checks.
  void play_and_release(const std::vector<Phase>& phases, const std::string& of, const std::string& picture,
                        const std::string& title);
  /// Like Solver::settle() with a tolerance of 1e-4. Throws Error if no equilibrium is found within `factor` times the
  /// case's longest_settling [s of simulated time].
  void settle(const Controls& target, double factor = 1);
  /// Calls `play`. If the guard stops the motion, checks that its report names a voxel and that the state is finite.
  /// `of` names the motion in the report, where a case has several.
  void hold_or_stop(const std::function<void()>& play, const std::string& of = {});
  /// Returns to rest at time 0 for another motion of the same model, with records of its own.
  void start_over();
  /// Sets displacements [m] and, unless empty, velocities [m/s]. The ledger starts again.
  void set(const Vectors& displacements, const Vectors& velocities = {});

  Vectors displacements() const;
  const Monitor& monitor() const { return monitor_; }       ///< latest record
  const EnergyLedger& energies() const { return ledger_; }  ///< latest record

  /// Checks that the imbalance of the ledger stayed within the fraction bounds.energy of the ledger's largest term, and
  /// plots the motion to `picture` if that is not empty.
  void check_balance(const std::string& of, const std::string& picture = {}, const std::string& title = {});
  /// Plots energies and the smallest J over time.
  void plot(const std::string& file, const std::string& title);

private:
  struct Moment
  {
    double time, kinetic, stored, unexplained, jacobian;
  };

  void record();

  CaseRun& run_;
  std::shared_ptr<const Model> model_;
  std::unique_ptr<Solver> solver_;
  std::unique_ptr<Guard> guard_;
  bool wants_ledger_;
  Monitor monitor_;
  EnergyLedger ledger_;
  // Extremes over time [J]. They are not in the ledger, because the guard may return the ledger to an earlier state.
  double worst_imbalance_ = 0, most_hourglass_ = 0, largest_ = 0;
  std::vector<Moment> moments_;
};

/// Hypodermis of Warburton & Maddock (Young's modulus 34 kPa), with the density 1000 kg/m3.
Material soft_tissue(double poisson = 0.49);
/// A box of soft tissue with voxels of edge 1 mm; size and damping come from the case's file.
Model damped_block(const CaseFile& file);
/// hold_face() makes the nodes of the lowest or highest plane along an axis rigid, and hold_ends() those of both
/// planes, of which `bone` moves the highest.
void hold_face(Model& model, int axis, bool upper, const std::string& bone = {});
void hold_ends(Model& model, int axis, const std::string& bone = {});

/// Largest |a - b| [m] of all nodes; without `b`, largest |a|.
double farthest(const Vectors& a, const Vectors& b = {});

/// Rotation by a rotation vector [rad] about a point [m].
RigidTransform turned_about(const Point& rotation, const Point& point);
RigidTransform shifted(const Point& shift);

/// A random number from -1 to 1 of a 32-bit generator.
template <class Random>
double drawn_from(Random& random)
{
  return 2 * (static_cast<double>(random()) / 4294967295.0) - 1;
}

}  // namespace frontalis
