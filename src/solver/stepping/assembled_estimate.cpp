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
// Numbers of steps between searches. After a change of activations or while bones move, the tissue stiffens as it
// follows: the next search is then after `shortest_time`, as far as the limits of steps allow it, and each further one
// after twice as many steps, or after `longest_valid` if the model is steady.
constexpr double shortest_time = 0.03;  // [s]
constexpr std::int64_t fewest_valid = 75, shortest_valid = 300, longest_valid = 2000;
// A search takes as long as 10 to 40 steps on a CPU and 40 to 70 on a GPU. Measured growth shortens steps, though often
// only the bound has grown, not the model: a search is made once the additional steps have cost about as much.
constexpr double search_cost = 20;
// The ratio is found for activations that are higher by this much than the present ones, so that searches are few while
// activations grow.
constexpr float activation_ahead = 0.5F;
constexpr float activation_tolerance = 0.02F;  // replaces `activation_ahead` where activations rest
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

void AssembledEstimate::steps_taken(int steps, double covered)
{
  steps_ += steps;
  if (known() && covered > found_)
    steps_lost_ += steps * (1 - std::sqrt(found_ / covered));
}

AssembledEstimate::Renewal AssembledEstimate::renew(const std::vector<float>& activation, bool moving, double measured,
                                                    double most, const Search& search)
{
  activation_.resize(activation.size());
  bool activated = false;
  for (std::size_t m = 0; m < activation.size(); ++m)
    activated = activated || activation[m] > activation_[m];
  if (moving)
    steps_valid_ = std::min(steps_valid_, steps_in_motion(found_));
  const bool grown = known() && steps_lost_ > search_cost;
  if (known() && !activated && !grown && steps_ < steps_valid_)
    return {};
  // A search after growth keeps the activations, because they may be on their way to those.
  const float ahead = activated ? activation_ahead : activation_tolerance;
  for (std::size_t m = 0; m < activation.size() && (activated || !grown); ++m)
    activation_[m] = activation[m] > 0 ? std::min(1.0F, activation[m] + ahead) : 0;
  const double squared = search(activation_), least = slowest_fall * found_;
  const bool confirmed =
      known() && !activated && !moving && squared > 0 && std::abs(squared - latest_) <= steady_change * latest_;
  const bool steady = confirmed && covered(measured) <= (1 + steady_change) * found_;
  latest_ = squared;
  if (!known() || activated || moving || (grown && !confirmed))
    steps_valid_ = steps_in_motion(squared);
  else if (!grown)
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
  steps_lost_ = 0;
  return { true, confirmed };
}

void AssembledEstimate::discard() { found_ = softest_ = 0; }

}  // namespace frontalis
