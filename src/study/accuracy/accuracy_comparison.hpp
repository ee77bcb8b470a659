#pragma once

#include "study/accuracy/accuracy_average.hpp"
#include "study/accuracy/accuracy_bench.hpp"

namespace frontalis
{

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

}  // namespace frontalis
