#pragma once

#include "study/accuracy/accuracy_average.hpp"
#include "study/accuracy/accuracy_bench.hpp"

namespace frontalis
{

/// Beside the plan's closed form, or else the reference's motion, averaged too where `average` is given.
AccuracyRow row_of(const MeasuredVariant& measured, const AccuracyPlan& plan, const VariantMotion& reference,
                   const SkinAverage* average);

/// From the finest levels of the reference's form: its error, the order observed, how far its skin moves, what is left
/// of differences when skins are averaged. Throws Error where there are no two levels.
void estimate_reference_error(const AccuracyPlan& plan, const VariantBench& bench, const SkinAverage& average,
                              AccuracyFindings& findings);

/// Notes of the order in the voxel edge of the standard setting's form and of the reference's, beside the closed form.
void tell_orders(const AccuracyPlan& plan, const VariantBench& bench, AccuracyFindings& findings);

}  // namespace frontalis
