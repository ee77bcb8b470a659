#include "solver/stepping/assembled_estimate.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

// A power iteration comes to its eigenvalue from below, and the model stiffens until the next search.
constexpr double margin = 1.05;               // of the frequency squared
constexpr double margin_after_change = 1.25;  // while activations have changed lately
constexpr std::int64_t longest_valid = 2000;  // steps: a search costs about one per cent of them
constexpr std::int64_t shortest_valid = 200;  // steps after activations changed: then twice as many each time
constexpr float activation_allowed = 0.1F;    // change of a muscle's activation since the search
constexpr double growth_allowed = 1.02;       // of the bound at nodes, squared, since the search
// A search begins with the mode of the one before, the first with random numbers.
constexpr int iterations = 16;
constexpr int first_iterations = 300;

}  // namespace

double AssembledEstimate::frequency_squared(double bound) const
{
  return state_.share < 1 ? state_.share * std::max(bound, state_.bound) : bound;
}

void AssembledEstimate::renew(const std::vector<float>& activation, const std::vector<float>& asked, double bound,
                              const std::function<double(int)>& search)
{
  // Fibres stiffen as they are activated, and what they move stiffens after that: until it has moved, the bound at
  // nodes counts.
  State& s = state_;
  bool changed = false;
  s.activation.resize(asked.size());
  for (std::size_t m = 0; m < asked.size(); ++m)
    changed = changed || std::abs(std::max(activation[m], asked[m]) - s.activation[m]) > activation_allowed;
  if (changed)
  {
    for (std::size_t m = 0; m < asked.size(); ++m)
      s.activation[m] = std::max(activation[m], asked[m]);
    s.share = 1;
    s.steps_valid = shortest_valid;
    s.steps = 0;
    return;
  }
  const bool waiting = s.steps_valid == shortest_valid && s.share == 1;
  const bool holds = s.bound > 0 && bound <= growth_allowed * s.bound;
  if (s.steps < s.steps_valid && (waiting || holds))
    return;
  const double found = search(s.bound > 0 ? iterations : first_iterations);
  const double allowance = s.steps_valid < longest_valid ? margin_after_change : margin;
  s.share = std::isfinite(found) ? std::min(1.0, allowance * found / bound) : 1.0;
  s.steps_valid = s.steps_valid > 0 ? std::min(2 * s.steps_valid, longest_valid) : longest_valid;
  s.steps = 0;
  s.bound = bound;
}

void AssembledEstimate::discard()
{
  state_.share = 1;
  state_.bound = 0;
}

}  // namespace frontalis
