#include "frontalis/runner/profile_report.hpp"

#include <fmt/format.h>

namespace frontalis
{
namespace
{

// The profile that the model was baked with; null if its cost was not measured.
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
  return fmt::format(
      "accuracy profile '{}': measured skin error {:.2g} mm RMS, measured cost {:.2g} s per simulated "
      "second{}{}",
      profile->name, 1e3 * profile->error, profile->cost, profile->machine.empty() ? "" : " on ", profile->machine);
}

std::string speed_report(const Model& model, double real_time_factor)
{
  std::string report = fmt::format("real-time factor {:.2g}", real_time_factor);
  const Model::AccuracyProfile* const present = present_profile(model);
  if (real_time_factor >= sufficient_real_time_factor || !(real_time_factor > 0) || present == nullptr)
    return report;
  report += ", too slow for real time; ";
  const double slower_than_measured = 1 / real_time_factor / present->cost;
  const Model::AccuracyProfile *fast_enough = nullptr, *cheapest = present;
  for (const Model::AccuracyProfile& profile : model.profiles)
  {
    if (!(profile.cost > 0))
      continue;
    if (profile.cost * slower_than_measured <= 1 && (fast_enough == nullptr || profile.error < fast_enough->error))
      fast_enough = &profile;
    if (profile.cost < cheapest->cost)
      cheapest = &profile;
  }
  if (fast_enough != nullptr)
    return report + fmt::format(
                        "profile '{}' would run in real time: about {:.2g} s per simulated second, skin error "
                        "{:.2g} mm RMS",
                        fast_enough->name, fast_enough->cost * slower_than_measured, 1e3 * fast_enough->error);
  report += "no profile of the scene would run in real time; ";
  return cheapest == present ? report + "this is the cheapest; a lower frame rate and fewer subscribers save time"
                             : report + fmt::format("the cheapest, '{}', would have a real-time factor of about {:.2g}",
                                                    cheapest->name, 1 / (cheapest->cost * slower_than_measured));
}

}  // namespace frontalis
