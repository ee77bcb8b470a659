#include "solver/stepping/assembled_estimate.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

// Margins are needed, because the search finds too low an eigenvalue, and the model may stiffen until the next search.
constexpr double frequency_margin = 1.1;  // factor on the squared frequency
// replaces `frequency_margin` while searches are frequent
constexpr double margin_in_motion = 1.25;
// Numbers of steps between searches. A search takes as long as 10 to 40 steps. After a change of activations or while
// bones move, the tissue stiffens as it follows: the next search is then after `shortest_time`, as far as the limits of
// steps allow it, and each further one after twice as many steps.
constexpr double shortest_time = 0.02;  // [s]
constexpr std::int64_t fewest_valid = 50, shortest_valid = 200, longest_valid = 2000;
// The ratio is found for activations that are higher by this much than the present ones, so that searches are few while
// activations grow.
constexpr float activation_ahead = 0.5F;
constexpr float activation_tolerance = 0.02F;  // replaces `activation_ahead` where activations rest
// If the bound at nodes grows by this factor, the estimate has grown with it, perhaps without need.
constexpr double growth_allowed = 1.1;
constexpr std::int64_t steps_until_growth_counts = 100;
// The estimate falls by at most this factor per search. A search may meet vibrating tissue in a moment in which it is
// soft, and the tissue stiffens again within a few dozen steps.
constexpr double slowest_fall = 0.7;

std::int64_t steps_in_motion(double frequency_squared)
{
  const double steps = 0.5 * shortest_time * std::sqrt(frequency_squared);
  return steps > fewest_valid ? static_cast<std::int64_t>(std::min(steps, double(shortest_valid))) : fewest_valid;
}

}  // namespace

double AssembledEstimate::bound_covered(double bound) const { return share_ < 1 ? std::max(bound, bound_) : bound; }

void AssembledEstimate::renew(const std::vector<float>& activation, bool moving, double bound, const Search& search)
{
  activation_.resize(activation.size());
  bool activated = false;
  for (std::size_t m = 0; m < activation.size(); ++m)
    activated = activated || activation[m] > activation_[m];
  if (moving)
    steps_valid_ = std::min(steps_valid_, steps_in_motion(frequency_squared(bound)));
  const bool grown = bound_ > 0 && bound > growth_allowed * bound_ && steps_ >= steps_until_growth_counts;
  if (bound_ > 0 && !activated && !grown && steps_ < steps_valid_)
    return;
  // A search after growth keeps the activations, because they may be on their way to those.
  const float ahead = activated ? activation_ahead : activation_tolerance;
  for (std::size_t m = 0; m < activation.size() && (activated || !grown); ++m)
    activation_[m] = activation[m] > 0 ? std::min(1.0F, activation[m] + ahead) : 0;
  const double found = search(activation_);
  if (bound_ == 0 || activated || moving)
    steps_valid_ = steps_in_motion(found);
  else if (!grown)
    steps_valid_ = std::min(2 * steps_valid_, longest_valid);
  const double allowance = grown || steps_valid_ < longest_valid ? margin_in_motion : frequency_margin;
  const double least = slowest_fall * share_ * bound_ / bound;
  share_ = found > 0 && std::isfinite(found) ? std::min(1.0, allowance * found / bound) : 1.0;
  if (share_ < least)
  {
    share_ = std::min(1.0, least);
    steps_valid_ = steps_in_motion(found);
  }
  steps_ = 0;
  bound_ = bound;
}

void AssembledEstimate::discard()
{
  share_ = 1;
  bound_ = 0;
}

}  // namespace frontalis
