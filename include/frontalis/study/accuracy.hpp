#pragma once

#include "frontalis/scene/scene.hpp"
#include "frontalis/solver/solver.hpp"
#include "frontalis/study/plot.hpp"
#include "frontalis/study/table.hpp"

#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace frontalis
{

/// One position of every knob of accuracy against time.
struct AccuracySetting
{
  AccuracyProfile profile;
  double poisson = 0;       ///< of every material; 0: the scene's
  double time_scaling = 1;  ///< times the scene's
  Backend backend = "cpu";
};

/// From rest to an activation over a ramp, then held; times are on the activations' clock [s].
struct ActivationHistory
{
  std::vector<float> activation;
  double ramp = 0.3;
  double hold = 0.3;
};

/// Makes the models of a study.
struct ModelMaker
{
  std::function<std::string(const AccuracySetting&)> content;  ///< everything that decides the model, as text
  std::function<Model(const AccuracySetting&)> bake;           ///< may throw Error: that setting has no model
};

struct AccuracyPlan
{
  /// Displacement [m] of a place of the skin [m] once settled, both in the face frame, where a closed form is known:
  /// settled skins are compared with it, and no finer solution serves as reference.
  std::function<std::array<double, 3>(const std::array<double, 3>&)> exact;
  AccuracySetting standard;               ///< the knobs are turned one at a time from here
  std::vector<AccuracyProfile> profiles;  ///< the scene's own, measured too
  std::vector<std::string> knobs;         ///< names of knob_names(); empty: all
  std::vector<double>
      edges;  ///< voxel edges, coarse to fine [m]; the last is the reference's, where there is no `exact`
  ActivationHistory history;
  double frame_rate = 30;  ///< published skins a simulated second [1/s]
  std::string folder;      ///< where finished variants are kept, by their content
  double budget = 0;       ///< wall seconds that the study may take; 0: as many as it needs
  bool quick = false;      ///< fewer positions of each knob
  int threads = 0;         ///< of the CPU; 0: one a core
};

/// How far a published skin is from the reference's [m].
struct SkinError
{
  double rms = NAN;  ///< weighted by area
  double largest = NAN;
};

/// One setting, measured.
struct AccuracyRow
{
  std::string name;  ///< what it differs in from the standard setting
  AccuracySetting setting;
  std::string fault;        ///< why it has no figures: unstable, no model; empty: it has
  SkinError error;          ///< of the worst phase of the history, settled included
  SkinError settled;        ///< once settled
  double averaged = NAN;    ///< as error, RMS, of the skin averaged over AccuracyFindings::averaged_over [m]
  double landmark = NAN;    ///< farthest that a landmark is off in any phase [m]
  double energy = NAN;      ///< what the ledger of energies leaves unexplained, over its largest term
  double cost = NAN;        ///< wall seconds a simulated second, skins published at the scene's frame rate
  double spread = NAN;      ///< of the repeated timings: quartiles' distance over the median
  double processors = NAN;  ///< share of its processors that it got while it was timed
  double step = NAN;        ///< wall seconds a step, median
  double steps = NAN;       ///< a simulated second
  double memory = NAN;      ///< of model and solver, on the host [bytes]
  double build = NAN;       ///< of the model [s]
  double voxels = NAN;
  bool noisy = false;  ///< spread above 20 %, or others took more than a fifth of the processors

  /// Whether a profile of a scene file can say it.
  bool is_profile(const AccuracySetting& standard) const
  {
    return setting.poisson == 0 && setting.time_scaling == 1 && setting.backend == standard.backend;
  }
};

/// The positions of one knob, by row.
struct KnobLine
{
  std::string knob;
  std::vector<std::size_t> rows;
};

struct AccuracyFindings
{
  bool complete = true;  ///< false: it was interrupted; what was finished is kept
  std::vector<AccuracyRow> rows;
  std::vector<KnobLine> knobs;
  std::vector<std::size_t> front;  ///< rows that no other beats in both error and cost, cheapest first
  AccuracySetting standard, reference;
  bool closed_form = false;    ///< what skins are compared with; otherwise the reference's
  double motion = 0;           ///< root mean square displacement of the reference's skin, largest of the phases [m]
  double reference_error = 0;  ///< [m], estimated
  double averaged_over = 0;    ///< standard deviation of the Gaussian [m]; 0: nothing was averaged
  double order = NAN;          ///< observed order of convergence in the voxel edge
  bool extrapolated = false;   ///< whether the order is one to extrapolate with (0.5 to 2.5)
  std::string machine;
  std::vector<std::string> notes;  ///< sentences: checks of the reference, what was left out, noise
};

/// Called with what is under way, the share done and the wall seconds that are left, as estimated; false interrupts.
using AccuracyProgress = std::function<bool(const std::string& stage, double done, double seconds_left)>;

std::vector<std::string> knob_names();

/// Measures the error and the cost of each setting. Throws Error: unknown knobs, a budget too small for one
/// comparison, a reference that diverges, a folder that cannot be written.
AccuracyFindings study_accuracy(const AccuracyPlan& plan, const ModelMaker& maker, const AccuracyProgress& progress);

/// All rows with their figures, the front's marked.
Table accuracy_table(const AccuracyFindings& findings);
/// Error against cost, each knob a line, the front with its points named, the reference's own error as a line.
Plot accuracy_plot(const AccuracyFindings& findings, const std::string& title);
/// What was found in words, and the table.
std::string accuracy_report(const AccuracyFindings& findings, const std::string& title);
/// The setting as it stands in a scene file under `accuracy`, with its measured figures: "NAME: {...}"; lengths in mm.
std::string profile_text(const AccuracyRow& row, const std::string& name, const std::string& machine);

/// The cheapest setting of the front with an error of at most `tolerance` [m]; the most accurate one that costs at most
/// `seconds` of wall time a simulated second. Throws Error telling what was measured where there is none.
const AccuracyRow& cheapest_within(const AccuracyFindings& findings, double tolerance);
const AccuracyRow& most_accurate_within(const AccuracyFindings& findings, double seconds);

}  // namespace frontalis
