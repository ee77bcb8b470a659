#pragma once

#include "watched_motion.hpp"

namespace frontalis
{

// one function a family; stability.cpp puts them together
std::vector<StabilityCase> hard_materials();
std::vector<StabilityCase> hard_shapes();
std::vector<StabilityCase> hard_muscles();
std::vector<StabilityCase> hard_constraints();
std::vector<StabilityCase> hard_times();

/// "held", "stopped with a report: ...", "skipped: ..." or "FAILED: ...".
std::string verdict_of(const Trial& trial);

}  // namespace frontalis
