#pragma once

#include "frontalis/byte_archive.hpp"
#include "frontalis/study/accuracy.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace frontalis
{

/// Where a skin and its landmarks stand, in the face frame [m].
struct SkinPhase
{
  std::vector<std::array<float, 3>> vertices;
  std::vector<std::array<float, 3>> landmarks;
};

/// What the motion of one variant was: the same on every run.
struct VariantMotion
{
  std::string fault;              ///< empty: it can be trusted
  std::vector<SkinPhase> phases;  ///< at rest, half of the ramp, its end, the end of the history, settled
  std::vector<float> area;        ///< of the skin at rest that belongs to each vertex [m2]
  double steps = 0;               ///< a second of the activations' clock
  double energy = 0;              ///< what the ledger leaves unexplained, over its largest term
  double residual = 0;            ///< of equilibrium, as Solver::settle tells it
  double voxels = 0;

  void archive(ByteArchive& archive);
};

/// What it cost: of one machine and one run.
struct VariantCost
{
  std::string machine;  ///< empty: not measured yet
  double step = 0;      ///< [s], median of the repetitions
  double spread = 0;
  double processors = 1;
  double skin = 0;  ///< one published skin [s]
  double memory = 0;
  double build = 0;  ///< [s]

  bool is_noisy() const { return spread > 0.2 || processors < 0.8; }
  void archive(ByteArchive& archive);
};

/// A motion under way.
struct VariantCheckpoint
{
  VariantMotion motion;     ///< as far as it is known; its steps are a number
  std::int64_t slices = 0;  ///< of the history that were played
  std::string solver;       ///< Solver::pack()

  void archive(ByteArchive& archive);
};

/// The machine that figures of cost belong to: processor or device and number of threads.
std::string machine_of(const Solver& solver, int threads);

using GoOn = std::function<bool(double done)>;

/// Where a motion goes on from, and what becomes of the states on its way: one about each minute of wall time and one
/// where it is interrupted.
struct Checkpoints
{
  std::optional<VariantCheckpoint> last;
  std::function<void(const VariantCheckpoint&)> keep;
};

/// Plays the history and settles. nullopt where `go_on` ended it; faults of the motion are told in the result. Without
/// `ledger` its energy is NaN. Interrupted and resumed it is the same, bit for bit.
std::optional<VariantMotion> play_variant(const std::shared_ptr<const Model>& model, const AccuracySetting& setting,
                                          const ActivationHistory& history, int threads, bool ledger,
                                          const Checkpoints& checkpoints, const GoOn& go_on);

/// Times steps with the history's activations reached, for about so many wall seconds.
VariantCost time_variant(const std::shared_ptr<const Model>& model, const AccuracySetting& setting,
                         const ActivationHistory& history, int threads, double seconds);

/// Bytes that the program has on its heap.
double heap_bytes();

/// Between two motions of the same skin, phase by phase; the first phase is rest, and displacements are compared.
/// Throws Error where the skins are not the same.
std::vector<SkinError> skin_errors(const VariantMotion& found, const VariantMotion& exact);
SkinError worst(const std::vector<SkinError>& errors);
/// Rest and settled alone of a motion; the same of a body whose settled displacements [m] are known at all places [m].
VariantMotion settled_part(const VariantMotion& motion);
VariantMotion exact_motion(const VariantMotion& like,
                           const std::function<std::array<double, 3>(const std::array<double, 3>&)>& displacement);
double landmark_error(const VariantMotion& found, const VariantMotion& exact);
/// Root mean square displacement [m], the largest of the phases.
double motion_size(const VariantMotion& motion);

/// Order p for which errors C h^p leave these differences between solutions at three edges, coarse to fine:
/// `coarse` between the first and the second, `fine` between the second and the third. NaN where there is none in 0..8.
double observed_order(const std::array<double, 3>& edges, double coarse, double fine);
/// The error that is left at the finest edge (Richardson): of `difference` to the solution at the edge before.
double richardson(double before, double finest, double difference, double order);

/// Finished variants, one file each, written whole or not at all.
class VariantStore
{
public:
  /// Makes the folder. Throws Error.
  explicit VariantStore(std::string folder);

  bool has_motion(const std::string& key) const;
  std::optional<VariantMotion> motion(const std::string& key) const;
  std::optional<VariantCost> cost(const std::string& key) const;
  void keep(const std::string& key, const VariantMotion& motion) const;
  void keep(const std::string& key, const VariantCost& cost) const;
  /// Gone when the variant's motion is kept.
  std::optional<VariantCheckpoint> checkpoint(const std::string& key) const;
  void keep(const std::string& key, const VariantCheckpoint& checkpoint) const;

private:
  std::string checkpoint_path(const std::string& key) const;

  std::string folder_;
};

/// Positions of the knobs. `critical` is the time step of the standard setting without scaled mass [s].
struct Sweep
{
  std::string knob;
  std::vector<AccuracySetting> settings;
};
std::vector<Sweep> knob_sweeps(const AccuracyPlan& plan, double critical);
/// What the Pareto front may be made of at one voxel edge.
std::vector<AccuracySetting> combinations(const AccuracyPlan& plan, double edge, double critical);
/// As accurate as the solver can be at an edge: assumed strain, no mass scaled; steps as long as the assembled model
/// allows, since halving them is checked.
AccuracySetting reference_setting(const AccuracySetting& standard, double edge);
/// What a setting differs in from the standard one, in words; "standard" where in nothing.
std::string name_of(const AccuracySetting& setting, const AccuracySetting& standard);
/// Wall time relative to the same motion by one-point float elements of edge 1 [m]: what a plan's time is estimated by.
double relative_time(const AccuracySetting& setting);

}  // namespace frontalis
