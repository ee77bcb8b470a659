#include "solver/stepping/assembled_estimate.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

// Margins are needed, because the search finds too low an eigenvalue, and the model may stiffen until the next search.
constexpr double frequency_margin = 1.1;  // factor on the squared frequency
// Largest relative change of what is found between successive searches of a steady model, and share by which what is
// measured may exceed the estimate.
constexpr double steady_change = 0.03;
// Numbers of steps between searches. A search takes as long as 10 to 40 steps. After a change of activations or while
// bones move, the tissue stiffens as it follows: the next search is then after `shortest_time`, as far as the limits of
// steps allow it, and each further one after twice as many steps, or after `longest_valid` if the model is steady.
constexpr double shortest_time = 0.02;  // [s]
constexpr std::int64_t fewest_valid = 50, shortest_valid = 200, longest_valid = 2000;
// The ratio is found for activations that are higher by this much than the present ones, so that searches are few while
// activations grow.
constexpr float activation_ahead = 0.5F;
constexpr float activation_tolerance = 0.02F;  // replaces `activation_ahead` where activations rest
// A search is made if what the estimate covers has grown by this factor, because the bound grows more than the model.
constexpr double growth_allowed = 1.25;
constexpr std::int64_t steps_until_growth_counts = 25;
// The estimate falls by at most this factor per search. A search may meet vibrating tissue in a moment in which it is
// soft, and the tissue stiffens again within a few dozen steps.
constexpr double slowest_fall = 0.7;

std::int64_t steps_in_motion(double frequency_squared)
{
  const double steps = 0.5 * shortest_time * std::sqrt(frequency_squared);
  return steps > fewest_valid ? static_cast<std::int64_t>(std::min(steps, double(shortest_valid))) : fewest_valid;
}

}  // namespace

double AssembledEstimate::covered(double measured) const { return std::max(found_, frequency_margin * measured); }

bool AssembledEstimate::in_motion() const { return known() && steps_valid_ < longest_valid; }

bool AssembledEstimate::renew(const std::vector<float>& activation, bool moving, double measured, double most,
                              const Search& search, bool closely)
{
  activation_.resize(activation.size());
  bool activated = false;
  for (std::size_t m = 0; m < activation.size(); ++m)
    activated = activated || activation[m] > activation_[m];
  if (moving)
    steps_valid_ = std::min(steps_valid_, std::max(fewest_valid, steps_in_motion(found_) / (closely ? 2 : 1)));
  const bool grown = known() && covered(measured) > growth_allowed * found_ && steps_ >= steps_until_growth_counts;
  if (known() && !activated && !grown && steps_ < steps_valid_)
    return false;
  // A search after growth keeps the activations, because they may be on their way to those.
  const float ahead = activated ? activation_ahead : activation_tolerance;
  for (std::size_t m = 0; m < activation.size() && (activated || !grown); ++m)
    activation_[m] = activation[m] > 0 ? std::min(1.0F, activation[m] + ahead) : 0;
  const double squared = search(activation_), least = slowest_fall * found_;
  const bool changes = !known() || activated || moving || grown;
  const bool steady = !changes && covered(measured) <= (1 + steady_change) * found_ &&
                      std::abs(squared - latest_) <= steady_change * latest_;
  latest_ = squared;
  if (changes)
    steps_valid_ = steps_in_motion(squared);
  else
    steps_valid_ = steady ? longest_valid : std::min(2 * steps_valid_, longest_valid);
  const double allowance = steps_valid_ < longest_valid ? margin_in_motion : frequency_margin;
  found_ = squared > 0 && std::isfinite(squared) ? allowance * squared : most;
  if (found_ < least)
  {
    found_ = least;
    steps_valid_ = steps_in_motion(squared);
  }
  softest_ = softest_ > 0 ? std::min(softest_, found_) : found_;
  steps_ = 0;
  return true;
}

void AssembledEstimate::discard() { found_ = softest_ = 0; }

}  // namespace frontalis
