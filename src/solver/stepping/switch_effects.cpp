// The functions of TimeStepper that switch effects.

#include "solver/stepping/time_stepper.hpp"

#include "solver/contact/past_rim.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace frontalis
{
namespace
{

// A node that begins to slide is moved to its level in one step, over at most this share of the shortest edge.
constexpr double largest_jump = 0.5;

}  // namespace

void TimeStepper::switch_effect(Effect effect, bool on)
{
  if (effect == Effect::sliding && on && !effects_.running().has(effect))
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
    backend_->measure_growth(std::numeric_limits<double>::infinity());
  displacements_were_set();
}

void TimeStepper::check_sliding_nodes() const
{
  NodalVectors u;
  displacements(u);
  const double farthest = farthest_from_level(*model_, u, motion_.controls.bone),
               allowed = largest_jump * shortest_edge();
  if (!(farthest <= allowed))
    throw Error(
        fmt::format("sliding cannot be switched on now: nodes have left their surface by up to {:.3g} mm (allowed: "
                    "{:.2g} mm); bring the face to rest first, or reset it",
                    1e3 * farthest, 1e3 * allowed));
}

}  // namespace frontalis
