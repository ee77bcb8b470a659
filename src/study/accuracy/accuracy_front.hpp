#pragma once

#include "frontalis/study/accuracy.hpp"

namespace frontalis
{

/// The rows that a scene's profile can express and that no other such row beats in both error and cost, cheapest first.
/// Errors below `floor` [m] count as equal, and a dearer row must have an error that is smaller by a twentieth.
std::vector<std::size_t> pareto_front(const std::vector<AccuracyRow>& rows, const AccuracySetting& standard,
                                      double floor);

}  // namespace frontalis
