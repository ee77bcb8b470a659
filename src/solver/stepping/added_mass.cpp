#include "solver/stepping/added_mass.hpp"

#include "solver/stepping/assembled_estimate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace frontalis
{
namespace
{

constexpr double most_at_node = 10;     // largest ratio of a node's mass to that at rest
constexpr double most_of_model = 0.01;  // largest proportion of the model's mass
constexpr double margin = 1.25;         // on the squared frequency, so that growing distortion seldom needs more
// Of what was added, beyond this part of the most, this share stays; relative growths below the least end.
constexpr double kept = 0.75, kept_share = 0.9, least_growth = 0.01;

}  // namespace

MassInMotion::MassInMotion(const Model& model, const Discretisation& discretisation)
    : allowed_(std::numeric_limits<double>::infinity()),
      total_mass_(std::accumulate(discretisation.node_mass.begin(), discretisation.node_mass.end(), 0.0))
{
  if (model.mass_scaling.in_motion > 0)
  {
    const double critical = model.mass_scaling.in_motion / model.time_step_share;
    allowed_ = 4 / (critical * critical) / AssembledEstimate::margin_in_motion;
  }
}

double MassInMotion::proportion(const std::vector<AddedMass>& added) const
{
  double sum = 0;
  for (const AddedMass& mass : added)
    sum += mass.now - mass.before;
  return sum / total_mass_;
}

bool MassInMotion::limits(double frequency_squared, const std::vector<AddedMass>& added) const
{
  return frequency_squared > allowed_ && std::isfinite(frequency_squared) && proportion(added) < 0.99 * most_of_model;
}

// A mode's squared frequency is divided by 1 + the sum of share times relative growth of mass. With growth in
// proportion to the share, the least mass is added to nodes of equal mass.
std::vector<AddedMass> MassInMotion::raise(const std::vector<FoundMode>& modes, std::vector<double>& node_mass,
                                           std::vector<AddedMass>& added) const
{
  struct Growth
  {
    std::int32_t node;
    double by;
  };
  std::vector<Growth> growth;
  for (const FoundMode& mode : modes)
  {
    double squares = 0;
    for (const ModeShare& of : mode.shares)
      squares += double(of.share) * double(of.share);
    for (const ModeShare& of : mode.shares)
      growth.push_back({ of.node, (margin * mode.frequency_squared / allowed_ - 1) * double(of.share) / squares });
  }
  std::stable_sort(growth.begin(), growth.end(), [](const Growth& a, const Growth& b) { return a.node < b.node; });
  std::size_t last = 0;
  for (std::size_t i = 1; i < growth.size(); ++i)
    if (growth[i].node == growth[last].node)
      growth[last].by += growth[i].by;
    else
      growth[++last] = growth[i];
  growth.resize(std::min(growth.size(), last + 1));
  double wanted = 0;
  for (const auto& [node, by] : growth)
    wanted += by * node_mass[node] / total_mass_;
  const double granted = std::min(1.0, (most_of_model - proportion(added)) / wanted);
  std::vector<AddedMass> raised, all;
  auto known = added.begin();
  for (const auto& [node, by] : growth)
  {
    while (known != added.end() && known->node < node)
      all.push_back(*known++);
    const bool first = known == added.end() || known->node > node;
    AddedMass mass = first ? AddedMass{ node, node_mass[node], node_mass[node] } : *known++;
    const double before = mass.now;
    mass.now = std::min(before * (1 + granted * by), most_at_node * mass.before);
    node_mass[node] = mass.now;
    all.push_back(mass);
    raised.push_back({ node, before, mass.now });
  }
  all.insert(all.end(), known, added.end());
  added = std::move(all);
  return raised;
}

std::vector<AddedMass> MassInMotion::fade(std::vector<double>& node_mass, std::vector<AddedMass>& added) const
{
  std::vector<AddedMass> faded, left;
  if (proportion(added) <= kept * most_of_model)
    return faded;
  for (AddedMass mass : added)
  {
    const double before = mass.now, more = kept_share * (before - mass.before);
    mass.now = more > least_growth * mass.before ? mass.before + more : mass.before;
    node_mass[mass.node] = mass.now;
    faded.push_back({ mass.node, before, mass.now });
    if (mass.now > mass.before)
      left.push_back(mass);
  }
  added = std::move(left);
  return faded;
}

std::vector<std::int32_t> nodes_of(const std::vector<AddedMass>& added)
{
  std::vector<std::int32_t> nodes;
  nodes.reserve(added.size());
  for (const AddedMass& mass : added)
    nodes.push_back(static_cast<std::int32_t>(mass.node));
  return nodes;
}

}  // namespace frontalis
