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

/// The motion of one variant, which is the same on every run.
struct VariantMotion
{
  std::string fault;              ///< why the motion cannot be used; empty: it can
  std::vector<SkinPhase> phases;  ///< at rest, mid-ramp, end of ramp, end of history, settled
  std::vector<float> area;        ///< area of the skin at rest, shared out to its vertices [m2]
  double steps = 0;               ///< time steps per second of the activations' clock
  double energy = 0;              ///< imbalance of the energy ledger over its largest term
  double residual = 0;            ///< remaining motion over the displacement, see Solver::settle()
  double voxels = 0;

  void archive(ByteArchive& archive);
};

/// A motion that is not finished.
struct VariantCheckpoint
{
  VariantMotion motion;     ///< so far; `steps` is the number of steps made
  std::int64_t slices = 0;  ///< slices of the history that have been played
  std::string solver;       ///< Solver::pack()

  void archive(ByteArchive& archive);
};

/// The machine on which costs are measured: processor or device, and number of threads.
std::string machine_of(const Solver& solver, int threads);

using GoOn = std::function<bool(double done)>;

/// The checkpoint to resume a motion from, and a function that stores further ones: about one per minute of wall time,
/// and one if the motion is interrupted.
struct Checkpoints
{
  std::optional<VariantCheckpoint> last;
  std::function<void(const VariantCheckpoint&)> keep;
};

/// Plays the history and settles. Returns nothing if `go_on` ended the motion; a motion that fails is returned with
/// its fault. Without `ledger` its energy is NaN. Interrupting and resuming does not change a bit of the result.
std::optional<VariantMotion> play_variant(const std::shared_ptr<const Model>& model, const AccuracySetting& setting,
                                          const ActivationHistory& history, int threads, bool ledger,
                                          const Checkpoints& checkpoints, const GoOn& go_on);

/// Times steps for about `seconds` of wall time after the history's activations are reached.
VariantCost time_variant(const std::shared_ptr<const Model>& model, const AccuracySetting& setting,
                         const ActivationHistory& history, int threads, double seconds);

/// Bytes on the heap of this program.
double heap_bytes();

/// Distance between the displacements of two motions of the same skin in each phase; phase 0 is the skin at rest.
/// Throws Error if the skins differ.
std::vector<SkinError> skin_errors(const VariantMotion& found, const VariantMotion& exact);
SkinError worst(const std::vector<SkinError>& errors);
/// The phases at rest and settled of a motion, and the same of a body whose settled displacements [m] are known for all
/// positions [m].
VariantMotion settled_part(const VariantMotion& motion);
VariantMotion exact_motion(const VariantMotion& like, const std::function<Vector3(const Vector3&)>& displacement);
double landmark_error(const VariantMotion& found, const VariantMotion& exact);
/// Root mean square displacement [m] of the phase where it is largest.
double motion_size(const VariantMotion& motion);

/// Averages the displacements of a skin over the neighbourhood of each vertex at rest, so that single folds do not
/// dominate the errors.
class SkinAverage
{
public:
  /// All motions must have the reference's rest positions. The weights are a Gaussian of this standard deviation [m]
  /// times the area.
  SkinAverage(const VariantMotion& reference, double deviation);

  /// The motion with averaged displacements; landmarks stay as they are.
  VariantMotion of(const VariantMotion& motion) const;
  /// Error against the averaged reference in the worst phase. Throws Error if skin_errors() does.
  SkinError error(const VariantMotion& motion) const;

private:
  std::vector<std::vector<std::pair<std::size_t, float>>> weights_;  // per vertex
  VariantMotion reference_;                                          // averaged
};

/// The order p for which errors C h^p explain the differences between solutions at three edges, coarse to fine:
/// `coarse` between the first and the second, `fine` between the second and the third. NaN if there is none in 0..8.
double observed_order(const std::array<double, 3>& edges, double coarse, double fine);
inline bool is_credible(double order) { return order >= 0.5 && order <= 2.5; }  ///< good enough to extrapolate with
/// Richardson's estimate of the error at the finest edge, from the difference to the solution at the edge before.
double richardson(double before, double finest, double difference, double order);

/// The settings of one knob, all others as in the standard setting.
struct Sweep
{
  std::string knob, words;  ///< as the command line and as plots name it
  std::vector<AccuracySetting> settings;
};
/// `critical`: time step of the standard setting without scaled mass [s].
std::vector<Sweep> knob_sweeps(const AccuracyPlan& plan, double critical);
/// The combinations of settings that are tried at one voxel edge.
std::vector<AccuracySetting> combinations(const AccuracyPlan& plan, double edge, double critical);
/// The most accurate setting at a voxel edge: assumed strain and no scaled mass. Its steps are as long as the assembled
/// model allows; the study checks what halving them changes.
AccuracySetting reference_setting(const AccuracySetting& standard, double edge);
/// The differences of a setting from the standard one in words; "standard" if there are none.
std::string name_of(const AccuracySetting& setting, const AccuracySetting& standard);
/// Wall time over that of the same motion with one-point single-precision elements of an edge of 1 m, for estimates.
double relative_time(const AccuracySetting& setting);

}  // namespace frontalis
