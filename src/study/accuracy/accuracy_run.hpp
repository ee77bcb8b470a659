#pragma once

#include "frontalis/study/accuracy.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace frontalis
{

/// Positions of a skin and its landmarks in the face frame [m].
struct SkinPhase
{
  std::vector<std::array<float, 3>> vertices;
  std::vector<std::array<float, 3>> landmarks;
};

/// The motion of one variant (a setting of the study), which is bitwise the same in every run.
struct VariantMotion
{
  std::string fault;              ///< why the motion cannot be used; empty: it can
  std::vector<SkinPhase> phases;  ///< skins at rest, mid-ramp, end of ramp, end of history, settled
  std::vector<float> area;        ///< area of the skin at rest that each vertex represents [m2]
  double steps = 0;               ///< number of time steps per second of the activation history
  double energy = 0;              ///< imbalance of the energy ledger divided by its largest term
  double residual = 0;            ///< remaining motion divided by the displacement, as in Solver::settle()
  double voxels = 0;

  void archive(ByteArchive& archive);
};

/// The state of an interrupted motion.
struct VariantCheckpoint
{
  VariantMotion motion;     ///< the motion so far; `steps` is the total number of steps
  std::int64_t slices = 0;  ///< slices of the history that have been simulated
  std::string solver;       ///< state of the solver, from Solver::pack()

  void archive(ByteArchive& archive);
};

/// The machine on which costs are measured: processor or device, and number of threads.
std::string machine_of(const Solver& solver, int threads);

/// Function that receives the completed fraction of a motion, 0..1, and returns false to interrupt the motion.
using GoOn = std::function<bool(double done)>;

/// The checkpoint from which to resume a motion, and a function that stores further ones, about one per minute of wall
/// time and one if the motion is interrupted between slices.
struct Checkpoints
{
  std::optional<VariantCheckpoint> last;
  std::function<void(const VariantCheckpoint&)> keep;
};

/// Simulates the history and settling. Returns nothing if `go_on` has interrupted the motion. An unstable motion is
/// returned with its fault. Without `ledger`, `energy` of the result is NaN. A resumed motion has bitwise the same
/// result as an uninterrupted one.
std::optional<VariantMotion> play_variant(const std::shared_ptr<const Model>& model, const AccuracySetting& setting,
                                          const ActivationHistory& history, int threads, bool ledger,
                                          const Checkpoints& checkpoints, const GoOn& go_on);

/// Times steps at the history's final activations for about `seconds` of wall time.
VariantCost time_variant(const std::shared_ptr<const Model>& model, const AccuracySetting& setting,
                         const ActivationHistory& history, int threads, double seconds);

/// Bytes that this program has allocated on the heap.
double heap_bytes();

/// Differences between the displacements of two motions, one per phase. Throws Error if they do not have the same skin.
std::vector<SkinError> skin_errors(const VariantMotion& found, const VariantMotion& exact);
SkinError worst(const std::vector<SkinError>& errors);
/// settled_part() returns the rest and settled phases of a motion. exact_motion() replaces the settled displacements
/// [m] by a function of the position at rest [m].
VariantMotion settled_part(const VariantMotion& motion);
VariantMotion exact_motion(const VariantMotion& like, const std::function<Vector3(const Vector3&)>& displacement);
double landmark_error(const VariantMotion& found, const VariantMotion& exact);
/// Root mean square displacement [m], the largest of all phases.
double motion_size(const VariantMotion& motion);

/// Averages displacements over the neighbourhood of each vertex, so that single folds do not dominate the errors.
class SkinAverage
{
public:
  /// The weights are the vertices' areas times a Gaussian of this standard deviation [m] between rest positions. All
  /// motions must have the rest positions of the reference.
  SkinAverage(const VariantMotion& reference, double deviation);

  /// The motion with averaged displacements; landmarks are not averaged.
  VariantMotion of(const VariantMotion& motion) const;
  /// Error against the averaged reference in the worst phase. Throws Error if skin_errors() does.
  SkinError error(const VariantMotion& motion) const;

private:
  std::vector<std::vector<std::pair<std::size_t, float>>> weights_;  // per vertex: neighbours and their weights
  VariantMotion reference_;                                          // averaged motion of the reference
};

/// The order p for which errors C h^p explain the differences between solutions at three edges h, coarse to fine.
/// `coarse`: difference between the first and the second; `fine`: between the second and the third. NaN if no p in 0..8
/// does.
double observed_order(const std::array<double, 3>& edges, double coarse, double fine);
/// Whether an observed order is plausible.
constexpr double least_credible_order = 0.5;
inline bool is_credible(double order) { return order >= least_credible_order && order <= 2.5; }
/// Richardson's estimate of the error at edge `finest`, from the difference to the solution at edge `before`. The least
/// credible order, for which the estimate is largest, stands for an order that is not credible.
double richardson(double before, double finest, double difference, double order);

/// Settings that differ from the standard setting in one knob.
struct Sweep
{
  std::string knob, words;  ///< name on the command line, and words in plots
  std::vector<AccuracySetting> settings;
};
/// `critical`: time step of the standard setting without scaled mass [s].
std::vector<Sweep> knob_sweeps(const AccuracyPlan& plan, double critical);
/// The combinations of knobs that are measured at one voxel edge.
std::vector<AccuracySetting> combinations(const AccuracyPlan& plan, double edge, double critical);
/// The most accurate setting at a voxel edge: assumed strain and no scaled mass. Its time step is estimated from the
/// assembled model; the study checks the effect of halving that step.
AccuracySetting reference_setting(const AccuracySetting& standard, double edge);
/// The differences of a setting from the standard one in words; "standard" if there are none.
std::string name_of(const AccuracySetting& setting, const AccuracySetting& standard);
/// Rough wall time relative to that of one-point, single-precision elements with an edge of 1 m.
double relative_time(const AccuracySetting& setting);

}  // namespace frontalis
