#pragma once

#include "frontalis/model/model.hpp"

#include <string>

namespace frontalis
{

/// What the model's accuracy profile was measured to be, in one sentence; empty where it was not measured.
std::string measured_profile(const Model& model);

/// How fast it runs here: a real-time factor, and where that is below 0.95, which of the scene's profiles would run in
/// real time on this machine, their measured costs taken in proportion to the present one's.
std::string speed_report(const Model& model, double real_time_factor);

}  // namespace frontalis
