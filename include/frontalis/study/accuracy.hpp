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

/// A setting of all knobs that trade accuracy for time.
struct AccuracySetting
{
  AccuracyProfile profile;
  double poisson = 0;       ///< Poisson's ratio of all materials; 0: as in the scene
  double time_scaling = 1;  ///< factor on the scene's time scaling
  Backend backend = "cpu";
};

/// Activations that grow from rest over a ramp and are then held; times are on the clock of the activations [s].
struct ActivationHistory
{
  std::vector<float> activation;
  double ramp = 0.3, hold = 0.3;
};

struct ModelMaker
{
  std::function<std::string(const AccuracySetting&)> content;  ///< all that the model depends on, as text
  std::function<Model(const AccuracySetting&)> bake;           ///< throws Error if the setting has no model
};

struct AccuracyPlan
{
  /// The closed form of the settled displacement [m] of a point of the skin [m], both in the face frame. If it is
  /// given, settled skins are compared with it, and there is no reference of finer voxels.
  std::function<Vector3(const Vector3&)> exact;
  AccuracySetting standard;               ///< each knob is varied from here
  std::vector<AccuracyProfile> profiles;  ///< the scene's own, which are measured too
  std::vector<std::string> knobs;         ///< knobs to vary, without combinations; empty: all
  std::vector<double> edges;  ///< voxel edges [m], coarse to fine; without `exact` the reference has the last
  ActivationHistory history;
  double frame_rate = 30;  ///< published skins per simulated second [1/s]
  std::string folder;      ///< where finished variants are kept
  double budget = 0;       ///< wall seconds that the study may take; 0: no limit
  bool quick = false;      ///< fewer settings per knob
  int threads = 0;         ///< CPU threads; 0: one per core
};

/// Distance of a published skin from the reference's [m]; the root mean square is weighted by area.
struct SkinError
{
  double rms = NAN, largest = NAN;
};

/// The cost of one setting on one machine, measured in one run.
struct VariantCost
{
  std::string machine;      ///< empty: not measured yet
  double step = NAN;        ///< wall seconds per step, median of repeated timings
  double spread = NAN;      ///< distance of their quartiles over their median
  double processors = NAN;  ///< share of its processors that the solver got while it was timed
  double skin = NAN;        ///< wall seconds per published skin
  double memory = NAN;      ///< host memory of model and solver [bytes]
  double build = NAN;       ///< wall seconds to make the model

  bool is_noisy() const { return spread > 0.2 || processors < 0.8; }  ///< the machine was disturbed
  void archive(ByteArchive& archive);
};

/// The figures of one setting.
struct AccuracyRow : VariantCost
{
  std::string name;  ///< its differences from the standard setting
  AccuracySetting setting;
  std::string fault;      ///< why there are no figures (unstable, no model); empty: no fault
  SkinError error;        ///< in the worst phase of the history, settled included
  SkinError settled;      ///< once settled
  double averaged = NAN;  ///< RMS error of the skin averaged over AccuracyFindings::averaged_over [m]
  double landmark = NAN;  ///< largest error of a landmark in any phase [m]
  double energy = NAN;    ///< imbalance of the energy ledger over its largest term
  double cost = NAN;      ///< wall seconds per simulated second, skins published at the scene's frame rate
  double steps = NAN;     ///< steps per simulated second
  double voxels = NAN;
};

/// The rows that vary one knob.
struct KnobLine
{
  std::string knob, words;  ///< as the command line and as plots name it
  std::vector<std::size_t> rows;
};

struct AccuracyFindings
{
  bool complete = true;  ///< false: the study was interrupted; finished variants are kept
  std::vector<AccuracyRow> rows;
  std::vector<KnobLine> knobs;
  std::vector<std::size_t> front;  ///< the Pareto front: rows that none beats in both error and cost, cheapest first
  AccuracySetting standard, reference;
  bool closed_form = false;    ///< skins are compared with the closed form instead of the reference
  double motion = 0;           ///< RMS displacement of the reference's skin in the phase where it is largest [m]
  double reference_error = 0;  ///< [m], estimated
  double averaged_over = 0;    ///< standard deviation of the Gaussian [m]; 0: nothing was averaged
  double order = NAN;          ///< observed order of convergence in the voxel edge
  std::string machine;
  std::vector<std::string> notes;  ///< sentences about checks of the reference, and what was left out
};

/// Called with the name of the present stage, the share of it that is done and an estimate of the wall seconds left;
/// returning false interrupts the study.
using AccuracyProgress = std::function<bool(const std::string& stage, double done, double seconds_left)>;

std::vector<std::string> knob_names();
/// Measures the error and the cost of each setting. Throws Error on unknown knobs, a budget that is too small for a
/// comparison, a reference that diverges and a folder that cannot be written.
AccuracyFindings study_accuracy(const AccuracyPlan& plan, const ModelMaker& maker, const AccuracyProgress& progress);

/// All rows with their figures; those on the Pareto front are marked.
Table accuracy_table(const AccuracyFindings& findings);
/// Error against cost: a line per knob, the Pareto front with named points, and the reference's own error.
Plot accuracy_plot(const AccuracyFindings& findings, const std::string& title);
/// The findings in words, and the table, as markdown.
std::string accuracy_report(const AccuracyFindings& findings, const std::string& title);
/// The setting with its measured figures as an entry of `accuracy` in a scene file, "NAME: {...}"; lengths in mm.
std::string profile_text(const AccuracyRow& row, const std::string& name, const std::string& machine);

/// The cheapest setting of the front with an error of at most `tolerance` [m], and the most accurate one that costs at
/// most `seconds` of wall time per simulated second. Throws Error with the nearest figures if there is none.
const AccuracyRow& cheapest_within(const AccuracyFindings& findings, double tolerance);
const AccuracyRow& most_accurate_within(const AccuracyFindings& findings, double seconds);

/// A body whose settled deformation is known, and a plan with its closed form and the edges and knobs that suit it.
struct ClosedForm
{
  std::string name;
  AccuracyPlan plan;
  ModelMaker maker;
};

/// "cantilever", "stretched_block" and "active_bar"; accuracy_closed_forms.cpp has their sources.
std::vector<ClosedForm> closed_forms();

}  // namespace frontalis
