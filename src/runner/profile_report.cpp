#include "frontalis/runner/profile_report.hpp"

#include <algorithm>
#include <cstdio>

namespace frontalis
{
namespace
{

std::string text(double value)
{
  char digits[32];
  std::snprintf(digits, sizeof digits, "%.2g", value);
  return digits;
}

const Model::AccuracyProfile* present_profile(const Model& model)
{
  for (const Model::AccuracyProfile& profile : model.profiles)
    if (profile.name == model.profile && profile.cost > 0)
      return &profile;
  return nullptr;
}

}  // namespace

std::string measured_profile(const Model& model)
{
  const Model::AccuracyProfile* const profile = present_profile(model);
  if (profile == nullptr)
    return {};
  return "accuracy profile '" + profile->name + "': its skin was measured to be off by " + text(1e3 * profile->error) +
         " mm RMS, and a simulated second to take " + text(profile->cost) + " s" +
         (profile->machine.empty() ? "" : " on " + profile->machine);
}

std::string speed_report(const Model& model, double real_time_factor)
{
  std::string report = "runs at " + text(real_time_factor) + " of real time here";
  const Model::AccuracyProfile* const present = present_profile(model);
  if (real_time_factor >= 0.95 || !(real_time_factor > 0) || present == nullptr)
    return report;
  // the most accurate that would do, else the cheapest there is
  const double slower = 1 / real_time_factor / present->cost;
  const Model::AccuracyProfile *enough = nullptr, *cheapest = present;
  for (const Model::AccuracyProfile& profile : model.profiles)
  {
    if (!(profile.cost > 0))
      continue;
    if (profile.cost * slower <= 1 && (enough == nullptr || profile.error < enough->error))
      enough = &profile;
    if (profile.cost < cheapest->cost)
      cheapest = &profile;
  }
  if (enough != nullptr)
    return report + ", too slow for real time; profile '" + enough->name + "' would do: about " +
           text(enough->cost * slower) + " s a simulated second, its skin off by " + text(1e3 * enough->error) +
           " mm RMS";
  report += ", too slow for real time, and no profile of the scene would do";
  return cheapest == present ? report + ": this is the cheapest"
                             : report + "; the cheapest, '" + cheapest->name + "', would run at about " +
                                   text(1 / (cheapest->cost * slower)) + " of it";
}

}  // namespace frontalis
