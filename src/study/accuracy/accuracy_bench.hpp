#pragma once

#include "study/accuracy/accuracy_run.hpp"

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace frontalis
{

/// Thrown if the progress function of a study interrupts it.
struct StudyInterrupted
{
};

struct MeasuredVariant
{
  std::string name;
  AccuracySetting setting;
  Backend played_by;  ///< the setting's, or another if the folder keeps a motion from another machine
  VariantMotion motion;
  VariantCost cost;
};

/// Measures variants one by one, and reuses earlier results from the study's folder. There each has a file for its
/// motion, its cost and a checkpoint, which are written whole or not at all.
class VariantBench
{
public:
  /// Keeps references to its arguments. Throws Error if the folder cannot be made or the standard setting has no
  /// model.
  VariantBench(const AccuracyPlan& plan, const ModelMaker& maker, const AccuracyProgress& progress);

  /// Index in done(). Throws Error, StudyInterrupted.
  std::size_t measure(const AccuracySetting& setting, const std::string& name = {});
  /// Null if the setting was not measured in this study.
  const MeasuredVariant* find(const AccuracySetting& setting) const;
  const std::vector<MeasuredVariant>& done() const { return done_; }

  /// Estimated wall seconds for a setting; 0 if the folder has its results.
  double predicted(const AccuracySetting& setting) const;
  /// Whether the budget has time for a setting. If not, left_out() increases by one.
  bool fits(const AccuracySetting& setting);
  int left_out() const { return left_out_; }
  /// The settings that follow, for the estimate of the time that is left.
  void expect(std::vector<AccuracySetting> settings) { pending_ = std::move(settings); }

  /// Names the setting that is not timed.
  void set_reference(const AccuracySetting& setting) { reference_ = setting; }
  /// Time step of the standard setting with `time_step: element`, without scaled mass [s].
  double critical_time_step() const { return critical_; }
  const std::string& machine() const { return machine_.at(plan_.standard.backend); }

private:
  /// Path of the setting's files without their extension.
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
  std::map<std::string, std::size_t> index_;  // by key
  std::vector<AccuracySetting> pending_;
  // estimated wall seconds: for the shortest variant, per unit of relative_time(), for timing a variant
  double overhead_ = 0, rate_ = 0, timing_;
  int left_out_ = 0;
};

/// The figures of a variant against the plan's closed form, or else against the reference's motion; `average` (may be
/// null) gives the error of averaged displacements too.
AccuracyRow row_of(const MeasuredVariant& measured, const AccuracyPlan& plan, const VariantMotion& reference,
                   const SkinAverage* average);

/// Estimates the reference's error from the finest levels of its form, and finds the observed order, the motion of its
/// skin and the differences of averaged skins. Throws Error if there are less than two levels.
void estimate_reference_error(const AccuracyPlan& plan, const VariantBench& bench, const SkinAverage& average,
                              AccuracyFindings& findings);

/// Notes the order in the voxel edge at which the errors of the standard setting's form and of the reference's form
/// fall, against the closed form.
void note_orders(const AccuracyPlan& plan, const VariantBench& bench, AccuracyFindings& findings);

/// The rows that a scene's profile can express and that no other such row beats in both error and cost, cheapest first.
/// Errors below `floor` [m] count as equal, and a dearer row must have an error that is smaller by a twentieth.
std::vector<std::size_t> pareto_front(const std::vector<AccuracyRow>& rows, const AccuracySetting& standard,
                                      double floor);

}  // namespace frontalis
