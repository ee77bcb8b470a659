// The functions of TimeStepper that change the masses of nodes.

#include "solver/stepping/time_stepper.hpp"

#include <cmath>
#include <limits>

namespace frontalis
{
namespace
{

// If a search finds a squared frequency of this many times the allowed one, another search follows once mass is added.
constexpr double search_again = 1.35;

}  // namespace

double TimeStepper::search_frequency(const std::vector<float>& activation)
{
  conditions_.activation = effects_.felt(activation);
  if (const auto faded = mass_in_motion_.fade(discretisation_.node_mass, motion_.added); !faded.empty())
  {
    masses_changed(faded);
    backend_->measure_growth(std::numeric_limits<double>::infinity(), false);
  }
  double squared = backend_->highest_frequency_squared();
  for (int round = 0; round < 2 && mass_in_motion_.limits(squared, motion_.added); ++round)
  {
    const auto modes = backend_->modes_above(mass_in_motion_.allowed());
    masses_changed(mass_in_motion_.raise(modes, discretisation_.node_mass, motion_.added));
    // The frequency falls as mass is added. Searching again at once pays only if it falls much.
    if (round > 0 || squared < search_again * mass_in_motion_.allowed())
      break;
    squared = backend_->highest_frequency_squared();
  }
  return squared;
}

void TimeStepper::masses_changed(const std::vector<AddedMass>& changed)
{
  if (changed.empty())
    return;
  if (ledger_)
    ledger_->masses_changed(changed);
  backend_->masses_changed(nodes_of(changed));
}

void TimeStepper::replace_masses(const std::vector<AddedMass>& before)
{
  if (before.empty() && motion_.added.empty())
    return;
  for (const AddedMass& mass : before)
    discretisation_.node_mass[mass.node] = mass.before;
  for (const AddedMass& mass : motion_.added)
    discretisation_.node_mass[mass.node] = mass.now;
  std::vector<std::int32_t> nodes = nodes_of(before);
  for (const std::int32_t node : nodes_of(motion_.added))
    nodes.push_back(node);
  backend_->masses_changed(nodes);
}

}  // namespace frontalis
