#pragma once

#include "frontalis/study/accuracy.hpp"

namespace frontalis
{

/// Rows that a profile can say and that no other such row beats in both error and cost, cheapest first. Errors below
/// `floor` [m] count as that, and a dearer row must be better by a twentieth.
std::vector<std::size_t> pareto_front(const std::vector<AccuracyRow>& rows, const AccuracySetting& standard,
                                      double floor);

}  // namespace frontalis
