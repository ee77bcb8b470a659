#pragma once

#include "frontalis/byte_archive.hpp"
#include "frontalis/scene/scene.hpp"
#include "frontalis/solver/solver.hpp"
#include "frontalis/study/plot.hpp"
#include "frontalis/study/table.hpp"

#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace frontalis
{

/// A value for every parameter ("knob") that trades accuracy for computing time.
struct AccuracySetting
{
  AccuracyProfile profile;
  double time_scaling = 1;  ///< factor on the scene's time scaling
  Backend backend = "cpu";
};

/// Activations that grow linearly from 0 during `ramp` and stay constant during `hold` [s, before time scaling].
struct ActivationHistory
{
  std::vector<float> activation;     ///< value of each muscle after the ramp, 0..1
  std::vector<RigidTransform> bone;  ///< motion of each bone after the ramp, as in Controls; empty: bones rest
  double ramp = 0.3, hold = 0.3;
};

struct ModelMaker
{
  std::function<std::string(const AccuracySetting&)> content;  ///< text that identifies the model
  std::function<Model(const AccuracySetting&)> bake;           ///< throws Error if there is no such model
};

struct AccuracyPlan
{
  /// Closed form of the displacement at equilibrium [m] at a rest position on the skin [m], in the face frame. If it is
  /// set, errors are those from it at equilibrium, and no reference with finer voxels is needed.
  std::function<Vector3(const Vector3&)> exact;
  AccuracySetting standard;               ///< the baseline; each sweep varies one of its knobs
  std::vector<AccuracyProfile> profiles;  ///< profiles of the scene, measured as further settings
  std::vector<std::string> knobs;         ///< knobs to vary one at a time; empty: all knobs, and combinations of them
  std::vector<double> edges;  ///< voxel edges [m], coarse to fine; without `exact` the last one is the reference's
  ActivationHistory history;
  std::string subject;     ///< sentence on the motion and the standard setting, the first of the notes; may be empty
  double frame_rate = 30;  ///< published skins per simulated second [1/s]
  std::string folder;      ///< folder that stores the results of finished settings
  double budget = 0;       ///< wall seconds that the study may take; 0: no limit
  bool quick = false;      ///< fewer settings per knob
  int threads = 0;         ///< CPU threads; 0: one per core
  void check() const;      ///< throws Error if a knob is unknown or the voxel edges cannot be compared
};

/// Difference of skin displacements from those of the reference or the closed form [m]; `rms` is weighted by area.
struct SkinError
{
  double rms = NAN, largest = NAN;
};

/// The cost of one setting on one machine, measured in one run.
struct VariantCost
{
  std::string machine;      ///< processor or device, number of threads; empty: not measured
  double step = NAN;        ///< wall seconds per step, median of repeated timings
  double spread = NAN;      ///< interquartile range of the timings divided by their median
  double processors = NAN;  ///< processor time of the solver during the timings, divided by the time available
  double skin = NAN;        ///< wall seconds per published skin
  double memory = NAN;      ///< host memory of model and solver [bytes]
  double build = NAN;       ///< wall seconds to bake the model

  bool is_noisy() const { return spread > 0.2 || processors < 0.8; }  ///< whether other programs interfered
  void archive(ByteArchive& archive);
};

/// The measured figures of one setting.
struct AccuracyRow : VariantCost
{
  std::string name;  ///< differences from the standard setting in words
  AccuracySetting setting;
  std::string fault;      ///< why there are no figures (unstable, no model); empty if there are figures
  SkinError error;        ///< largest over all phases of the history and the settled state
  SkinError settled;      ///< error in the settled state
  double averaged = NAN;  ///< RMS error of the skin averaged over AccuracyFindings::averaged_over [m]
  double landmark = NAN;  ///< largest error of a landmark in any phase [m]
  double energy = NAN;    ///< imbalance of the energy ledger divided by its largest term
  double cost = NAN;      ///< wall seconds per simulated second, with skins published at the scene's frame rate
  double steps = NAN;     ///< steps per simulated second
  double voxels = NAN;
};

struct KnobLine
{
  std::string knob, words;        ///< names on the command line and in plots
  std::vector<std::size_t> rows;  ///< indices into AccuracyFindings::rows; one knob varies in them
};

struct AccuracyFindings
{
  bool complete = true;  ///< false: interrupted; results of finished settings are stored
  std::vector<AccuracyRow> rows;
  std::vector<KnobLine> knobs;
  std::vector<std::size_t> front;  ///< indices of the Pareto-optimal rows in cost and error, cheapest first
  AccuracySetting standard, reference;
  bool closed_form = false;    ///< whether errors are relative to the closed form instead of the reference
  double motion = 0;           ///< largest RMS displacement of the reference's skin in any phase [m]
  double reference_error = 0;  ///< estimated RMS error of the reference [m]
  double averaged_over = 0;    ///< standard deviation of the Gaussian that averages displacements [m]; 0: none
  double order = NAN;          ///< observed order of convergence in the voxel edge
  std::string machine;
  std::vector<std::string> notes;  ///< sentences about checks of the reference and settings that were left out
};

/// Called with the name of the setting that is being measured, its completed fraction (0..1), and an estimate of the
/// wall seconds for all following settings. Returning false interrupts the study.
using AccuracyProgress = std::function<bool(const std::string& setting, double done, double seconds_left)>;

std::vector<std::string> knob_names();
/// Measures each setting. Throws Error as AccuracyPlan::check() does, and if the budget is too small for a comparison,
/// the reference diverges or the folder cannot be written.
AccuracyFindings study_accuracy(const AccuracyPlan& plan, const ModelMaker& maker, const AccuracyProgress& progress);

/// All rows with their figures; those on the Pareto front are marked.
Table accuracy_table(const AccuracyFindings& findings);
/// Error against cost: one line per knob, the Pareto front with named points, and the error of the reference itself.
Plot accuracy_plot(const AccuracyFindings& findings, const std::string& title);
/// The findings in words, and the table, as markdown.
std::string accuracy_report(const AccuracyFindings& findings, const std::string& title);
/// The setting with its measured figures as an entry of `accuracy` in a scene file, "NAME: {...}"; lengths in mm.
std::string profile_text(const AccuracyRow& row, const std::string& name, const std::string& machine);

/// The cheapest setting that a scene can have with an error of at most `tolerance` [m], and the most accurate one that
/// costs at most `seconds` of wall time per simulated second. Throws Error with the nearest figures if there is none.
const AccuracyRow& cheapest_within(const AccuracyFindings& findings, double tolerance);
const AccuracyRow& most_accurate_within(const AccuracyFindings& findings, double seconds);

/// A body whose equilibrium has a closed form (accuracy_closed_forms.cpp has the sources), and the plan of its study.
struct ClosedForm
{
  std::string name;
  AccuracyPlan plan;
  ModelMaker maker;
};

std::vector<ClosedForm> closed_forms();

}  // namespace frontalis
