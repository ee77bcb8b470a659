#include "solver/stepping/assembled_estimate.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

// Margins are needed, because power iteration gives too low an eigenvalue, and the model may stiffen until the next
// search.
constexpr double frequency_margin = 1.05;  // factor on the squared frequency
// replaces `frequency_margin` in the first search and after recent changes of activation
constexpr double margin_after_change = 1.25;
// largest number of steps for which a search is valid; a search takes about 1 % of the time of 2000 steps
constexpr std::int64_t longest_valid = 2000;
// number of steps without a search after a change of activation; each search then doubles the number
constexpr std::int64_t shortest_valid = 200;
constexpr float activation_allowed = 0.1F;  // change of a muscle's activation since the search
constexpr double growth_allowed = 1.02;     // allowed growth of the squared frequency bound at nodes since the search
// A search starts from the mode of the previous search. The first search starts from random numbers and needs more
// iterations.
constexpr int iterations = 16;
constexpr int first_iterations = 300;

}  // namespace

double AssembledEstimate::frequency_squared(double bound) const
{
  return share_ < 1 ? share_ * std::max(bound, bound_) : bound;
}

void AssembledEstimate::renew(const std::vector<float>& activation, const std::vector<float>& asked, double bound,
                              const std::function<double(int)>& search)
{
  // Fibres stiffen as they are activated, and the tissue that they pull stiffens later. Until then the bound at nodes
  // is used.
  bool changed = false;
  activation_.resize(asked.size());
  for (std::size_t m = 0; m < asked.size(); ++m)
    changed = changed || std::abs(std::max(activation[m], asked[m]) - activation_[m]) > activation_allowed;
  if (changed)
  {
    for (std::size_t m = 0; m < asked.size(); ++m)
      activation_[m] = std::max(activation[m], asked[m]);
    share_ = 1;
    steps_valid_ = shortest_valid;
    steps_ = 0;
    return;
  }
  const bool waiting = steps_valid_ == shortest_valid && share_ == 1;
  const bool holds = bound_ > 0 && bound <= growth_allowed * bound_;
  if (steps_ < steps_valid_ && (waiting || holds))
    return;
  const double found = search(bound_ > 0 ? iterations : first_iterations);
  const double allowance = steps_valid_ < longest_valid ? margin_after_change : frequency_margin;
  share_ = std::isfinite(found) ? std::min(1.0, allowance * found / bound) : 1.0;
  steps_valid_ = steps_valid_ > 0 ? std::min(2 * steps_valid_, longest_valid) : longest_valid;
  steps_ = 0;
  bound_ = bound;
}

void AssembledEstimate::discard()
{
  share_ = 1;
  bound_ = 0;
}

}  // namespace frontalis
