// The functions of TimeStepper that switch effects.

#include "solver/stepping/time_stepper.hpp"

#include "frontalis/error.hpp"
#include "solver/contact/past_rim.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace frontalis
{
namespace
{

// A node that begins to slide is moved to its level in one step, over at most this share of the shortest edge.
constexpr double largest_jump = 0.5;

}  // namespace

void TimeStepper::switch_effect(Effect effect, bool on)
{
  if (effect == Effect::sliding && on && !slides())
    check_sliding_nodes();
  if (!effects_.change(effect, on))
    return;
  renew_conditions();
  if (is_of_fibres(effect))
  {
    discretisation_.bound(effects_.running());
    controller_.set_bound_at_rest(discretisation_.frequency_squared_max);
  }
  effects_switched({ effect });
}

// The discretisation's bounds must already be those of the running effects.
void TimeStepper::effects_switched(const std::vector<Effect>& effects)
{
  backend_->effects_switched();
  if (ledger_)
    ledger_->effects_switched();
  if (motion_.diverged)
    return;
  if (std::none_of(effects.begin(), effects.end(), is_of_fibres))
  {
    open_ledger();
    return;
  }
  // Until the next search, steps follow the bound itself.
  if (model_->time_step_estimate == TimeStepEstimate::assembled)
    backend_->measure_growth(std::numeric_limits<double>::infinity(), false);
  displacements_were_set();
}

bool TimeStepper::slides() const { return !model_->sliding.empty() && effects_.running().has(Effect::sliding); }

void TimeStepper::check_sliding_nodes() const
{
  if (motion_.diverged)
    return;
  NodalVectors u;
  displacements(u);
  const double farthest = farthest_from_level(*model_, u, motion_.controls.bone),
               allowed = largest_jump * shortest_edge();
  if (farthest <= allowed)
    return;
  const std::string how_far =
      std::isfinite(farthest) ? fmt::format("their distance from their surface by up to {:.3g} mm (allowed: {:.2g} mm)",
                                            1e3 * farthest, 1e3 * allowed)
                              : "the known part of their surface";
  throw Error("sliding cannot be switched on now: nodes have left " + how_far +
              "; bring the face to rest first, or reset it");
}

}  // namespace frontalis
