// when the weights of nodes are sought by which the time step is bounded

#include "stepping_solver.hpp"

#include <algorithm>

namespace frontalis
{
namespace
{

constexpr double gains_from = 1.1;       // of the frequency squared at rest
constexpr std::int64_t good_for = 1024;  // steps; a search costs as much as some of them
constexpr std::int64_t shortest_good_for = 256;
constexpr double growth_allowed = 1.1;  // of the frequency squared since the search

}  // namespace

// Where the assembled model is asked for, the bound only tells how that has grown.
bool SteppingSolver::stiffened() const
{
  return model_->time_step_estimate != TimeStepEstimate::assembled && !discretisation_.assumed_strain &&
         !discretisation_.selective_reduced && frequency_squared_ > gains_from * discretisation_.frequency_squared_max;
}

bool SteppingSolver::weights_due() const
{
  const std::int64_t steps = profile_.steps - weighted_at_step_;
  if (wary_ > 0 || restless_ > 0 || steps < shortest_good_for || (weights_.of_node.empty() && !stiffened()))
    return false;
  return steps >= good_for || frequency_squared_ > growth_allowed * weighted_at_frequency_;
}

double SteppingSolver::weigh_nodes()
{
  const double squared = find_weights(weights_);
  weights_changed();
  weighted_at_step_ = profile_.steps;
  weighted_at_frequency_ = squared;
  return squared;
}

// What vibrates needs the margin that the bound without weights leaves.
void SteppingSolver::drop_weights()
{
  if (weights_.of_node.empty())
    return;
  frequency_squared_ *= weights_.gain;
  latest_seen_ *= weights_.gain;
  weights_ = {};
  weights_changed();
  weighted_at_step_ = profile_.steps;
  weighted_at_frequency_ = 0;
}

// what was believed with other weights goes along
void SteppingSolver::expect_weighted(double squared)
{
  if (!(squared > 0 && latest_seen_ > 0))
    return;
  frequency_squared_ = std::max(frequency_squared_ * squared / latest_seen_, discretisation_.frequency_squared_max);
  weighted_at_frequency_ = frequency_squared_;
  latest_seen_ = squared;
}

}  // namespace frontalis
