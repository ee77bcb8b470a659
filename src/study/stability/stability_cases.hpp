#pragma once

#include "frontalis/physics/number.hpp"
#include "frontalis/solver/guard.hpp"
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

  /// A count that the file has for short runs and, as KEY_in_full, for long ones.
  double count(const std::string& key) const;
  /// Checks a figure against the bound of the file's bounds.KEY, which has the unit of the figure.
  void check(const std::string& what, const std::string& unit, double expected, double found, const std::string& key);
  /// The same with a bound in percent of the expected figure.
  void check_relative(const std::string& what, const std::string& unit, double expected, double found,
                      const std::string& key);
};

// one function per family of cases, by name; stability.cpp combines them with their files
using CaseFunctions = std::vector<std::pair<std::string, void (*)(CaseRun&)>>;
CaseFunctions hard_materials();
CaseFunctions hard_shapes();
CaseFunctions hard_muscles();
CaseFunctions hard_constraints();
CaseFunctions hard_times();

/// A motion under the guard whose energies, worst voxel and hourglass share are recorded in the case's trial.
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
    int looks = 1;
  };
  /// Advances in equal parts, as many as there are looks, and records energies after each.
  void advance(const Phase& phase);
  /// Plays phases, plots them and then releases the model for a while (the case's in_the_end). Checks that energy was
  /// explained throughout to a share (bounds.energy) and that no node is farther from its rest than bounds.left.
  void play_and_release(const std::vector<Phase>& phases, const std::string& of, const std::string& picture,
                        const std::string& title);
  /// Like Solver::settle() with a tolerance of 1e-4. Throws Error if no equilibrium is reached within the case's
  /// longest_settling, times a factor, of simulated time.
  void settle(const Controls& target, double factor = 1);
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
  void check_balance(const std::string& of, const std::string& picture = {}, const std::string& title = {});
  /// Energies over time and the smallest J, as a picture.
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
  // [J]; kept here, since the guard may take the ledger back to an earlier state
  double worst_imbalance_ = 0, most_hourglass_ = 0, largest_ = 0;
  std::vector<Moment> moments_;
};

/// The hypodermis of the published forehead, at the density of tissue.
Material soft_tissue(double poisson = 0.49);
/// A box of voxels of soft tissue, edge 1 mm, of the size and damping that a case's file gives.
Model damped_block(const CaseFile& file);
/// Makes the lowest or the highest plane of nodes along an axis rigid, as hold(); and both, of which the bone moves the
/// highest.
void hold_face(Model& model, int axis, bool upper, const std::string& bone = {});
void hold_ends(Model& model, int axis, const std::string& bone = {});

inline physics::Vec3<double> vector(const Point& p) { return { p[0], p[1], p[2] }; }
/// Largest of |a - b| [m] over all nodes; without `b` of |a|.
double farthest(const Vectors& a, const Vectors& b = {});

/// Rigid motion by a rotation vector [rad] about a point [m], and by a shift [m].
RigidTransform turned_about(const Point& rotation, const Point& point);
RigidTransform shifted(const Point& shift);

/// A number from -1 to 1.
template <class Random>
double drawn_from(Random& random)
{
  return 2 * (static_cast<double>(random()) / 4294967295.0) - 1;
}

}  // namespace frontalis
