#pragma once

#include "study/stability/guarded_trial.hpp"
#include "study/stability/stability_file.hpp"

namespace frontalis
{

// one function per family of cases, by name; stability.cpp combines them with their files
using CaseFunctions = std::vector<std::pair<std::string, void (*)(const StabilitySettings&, const CaseFile&, Trial&)>>;
CaseFunctions hard_materials();
CaseFunctions hard_shapes();
CaseFunctions hard_muscles();
CaseFunctions hard_constraints();
CaseFunctions hard_times();

/// "held", "stopped with a report: ...", "skipped: ..." or "FAILED: ...".
std::string verdict_of(const Trial& trial);

}  // namespace frontalis
