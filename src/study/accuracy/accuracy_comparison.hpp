#pragma once

#include "study/accuracy/accuracy_bench.hpp"

#include <utility>
#include <vector>

namespace frontalis
{

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
