#pragma once

#include "accuracy_bench.hpp"

namespace frontalis
{

/// Beside the plan's closed form, or else the reference's motion.
AccuracyRow row_of(const MeasuredVariant& measured, const AccuracyPlan& plan, const VariantMotion& reference);

/// From the finest levels of the reference's form: its error, the order observed, how far its skin moves. Throws Error
/// where there are no two.
void estimate_reference_error(const AccuracyPlan& plan, const VariantBench& bench, AccuracyFindings& findings);

/// Notes of the order in the voxel edge of the standard setting's form and of the reference's, beside the closed form.
void tell_orders(const AccuracyPlan& plan, const VariantBench& bench, AccuracyFindings& findings);

}  // namespace frontalis
