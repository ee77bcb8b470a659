#pragma once

#include "study/accuracy/accuracy_run.hpp"

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace frontalis
{

/// Thrown if the progress function of a study asks for an interruption.
struct StudyInterrupted
{
};

struct MeasuredVariant
{
  std::string name;
  AccuracySetting setting;
  Backend played_by;  ///< backend that computed the motion; not the setting's if another machine stored the motion
  VariantMotion motion;
  VariantCost cost;
};

/// Measures variants (settings of a study) one by one and reuses earlier results from the study's folder. The folder
/// has one file each for a variant's motion, cost and checkpoint. Files are written completely or not at all.
class VariantBench
{
public:
  /// The arguments must outlive this object. Throws Error if folder or model of the standard setting cannot be made.
  VariantBench(const AccuracyPlan& plan, const ModelMaker& maker, const AccuracyProgress& progress);

  /// Measures a setting and returns its index in done(). Throws Error, StudyInterrupted.
  std::size_t measure(const AccuracySetting& setting, const std::string& name = {});
  /// The results of a setting; null if it was not measured in this study.
  const MeasuredVariant* find(const AccuracySetting& setting) const;
  const std::vector<MeasuredVariant>& done() const { return done_; }

  /// Estimated wall seconds for a setting; 0 if the folder has its results.
  double predicted(const AccuracySetting& setting) const;
  /// Whether the remaining budget suffices for a setting. If not, left_out() increases by one.
  bool fits(const AccuracySetting& setting);
  int left_out() const { return left_out_; }
  /// Announces the settings that will be measured next, for the estimate of the remaining time.
  void expect(std::vector<AccuracySetting> settings) { pending_ = std::move(settings); }

  /// Sets the reference's setting, which is not timed.
  void set_reference(const AccuracySetting& setting) { reference_ = setting; }
  /// Critical time step [s] of the standard setting with `time_step: element` and without scaled mass.
  double critical_time_step() const { return critical_; }
  const std::string& machine() const { return machine_.at(plan_.standard.backend); }

private:
  /// Path of the setting's files, without the extension.
  std::string key_of(const AccuracySetting& setting, const Backend& backend) const;
  std::string key_of(const AccuracySetting& setting) const { return key_of(setting, setting.backend); }
  bool is_reference(const AccuracySetting& setting) const;
  std::optional<Backend> kept_backend(const AccuracySetting& setting) const;
  bool is_timed(const AccuracySetting& setting, const std::optional<VariantCost>& cost) const;
  void learn(const AccuracySetting& setting, double wall);

  const AccuracyPlan& plan_;
  const ModelMaker& maker_;
  const AccuracyProgress& progress_;
  double begin_;
  std::map<Backend, std::string> machine_;
  double critical_ = 0;
  std::optional<AccuracySetting> reference_;
  std::vector<MeasuredVariant> done_;
  std::map<std::string, std::size_t> index_;  // key to index in done_
  std::vector<AccuracySetting> pending_;
  // Estimates of wall seconds: of the shortest variant, per unit of relative_time(), and of timing a variant.
  double overhead_ = 0, rate_ = 0, timing_;
  int left_out_ = 0;
};

/// The figures of a variant. Errors are relative to the plan's closed form or, without one, to the reference's motion.
/// With `average` (may be null) the row also has the error of averaged displacements.
AccuracyRow row_of(const MeasuredVariant& measured, const AccuracyPlan& plan, const VariantMotion& reference,
                   const SkinAverage* average);

/// Estimates the reference's error from its coarser versions, and adds the observed order, the motion of its skin and
/// the differences of averaged skins to the findings. Throws Error if there is no coarser version.
void estimate_reference_error(const AccuracyPlan& plan, const VariantBench& bench, const SkinAverage& average,
                              AccuracyFindings& findings);

/// Adds notes on the order of convergence to the closed form, for the standard setting and that of the reference.
void note_orders(const AccuracyPlan& plan, const VariantBench& bench, AccuracyFindings& findings);

/// Indices of the rows that are Pareto-optimal among those that a scene's profile can express, cheapest first. Errors
/// below `floor` [m] count as equal. A more expensive row counts only if its error is at least 5 % smaller.
std::vector<std::size_t> pareto_front(const std::vector<AccuracyRow>& rows, const AccuracySetting& standard,
                                      double floor);

}  // namespace frontalis
