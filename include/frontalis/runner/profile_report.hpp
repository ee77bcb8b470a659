#pragma once

#include "frontalis/model/model.hpp"

#include <string>

namespace frontalis
{

/// The measured error and cost of the model's accuracy profile, in one sentence; empty if they were not measured.
std::string measured_profile(const Model& model);

/// Smallest real-time factor with which a face counts as running in real time.
constexpr double sufficient_real_time_factor = 0.95;

/// The real-time factor, in one sentence. If it is not sufficient, the sentence also names the most accurate of the
/// scene's profiles that would run in real time on this machine. The cost of another profile on this machine is
/// estimated as its measured cost times the present cost of the model's own profile, divided by the measured cost of
/// that profile.
std::string speed_report(const Model& model, double real_time_factor);

}  // namespace frontalis
