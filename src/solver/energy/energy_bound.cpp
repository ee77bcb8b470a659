#include "solver/energy/energy_bound.hpp"

#include "solver/stepping/discretisation.hpp"
#include "frontalis/physics/ramp.hpp"
#include "frontalis/solver/rigid_motion.hpp"
#include "solver/stepping/nodal_loads.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

constexpr double margin = 2;            // safety factor for effects that the bound neglects
constexpr double active_stretch = 1.2;  // range of stretch in which a fibre pulls: 0.4 to 1.6
// energy of a passive fibre at a stretch of 1.6, divided by its reference stress times its volume
constexpr double passive_stretch = 0.3;
constexpr double small_strain = 1e-4;  // strain whose energy rounding errors alone may supply

}  // namespace

EnergyBound::EnergyBound(const Model& model) : model_(model), fibres_(model.muscles.size(), 0)
{
  const Discretisation discretisation(model);
  viscous_ = discretisation.viscous_terms > 0;

  // For each node, the indices of the bones that drive it, and the number of bones plus the indices of the loads that
  // do so.
  const auto bones = static_cast<std::int32_t>(model.bones.size());
  std::vector<std::vector<std::int32_t>> drivers(model.nodes.size());
  const auto drive = [&](std::int32_t node, std::int32_t driver)
  {
    auto& of_node = drivers[static_cast<std::size_t>(node)];
    if (driver >= 0 && std::find(of_node.begin(), of_node.end(), driver) == of_node.end())
      of_node.push_back(driver);
  };
  const std::vector<std::int32_t> bone = moving_bones(model);
  for (std::size_t n = 0; n < bone.size(); ++n)
    drive(static_cast<std::int32_t>(n), bone[n]);
  std::vector<EnergySupply> supplies;
  for (const auto& effect : discretisation.added)
  {
    stored_ += effect->energy_at_rest();
    const std::vector<EnergySupply> more = effect->supplies();
    supplies.insert(supplies.end(), more.begin(), more.end());
  }
  for (const EnergySupply& body : supplies)
    for (const std::int32_t e : body.bound->voxel)
      for (const std::int32_t node : model.voxel_nodes[static_cast<std::size_t>(e)])
        drive(node, body.bone);
  for (const auto& node : model.prescribed)
    drive(node.node, bones + node.load);
  std::vector<double> stiffness(model.bones.size() + model.loads.size(), 0);

  const double shortest = *std::min_element(model.spacing.begin(), model.spacing.end());
  VoxelProperties voxel;
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
  {
    discretisation.voxel(e, voxel);
    const double own = 8 * voxel.stiffness;
    floor_ += 0.5 * own * small_strain * small_strain * shortest * shortest;
    for (auto f = model.fibre_begin[e]; f < model.fibre_begin[e + 1]; ++f)
      fibres_[model.fibre_muscle[f]] +=
          double(model.fibre_weight[f]) * voxel.tissue_volume * model.muscles[model.fibre_muscle[f]].stress_reference;
    std::vector<std::int32_t> seen;
    for (const auto node : model.voxel_nodes[e])
      for (const std::int32_t driver : drivers[static_cast<std::size_t>(node)])
        if (std::find(seen.begin(), seen.end(), driver) == seen.end())
        {
          seen.push_back(driver);
          stiffness[static_cast<std::size_t>(driver)] += own;
        }
  }
  for (std::int32_t d = 0; d < static_cast<std::int32_t>(stiffness.size()); ++d)
    if (stiffness[d] > 0)
      (d < bones ? bones_ : prescribed_).push_back({ d < bones ? d : d - bones, stiffness[d] });

  double squared = 0;
  const auto& g = model.gravity;
  const double pull = g[0] * g[0] + g[1] * g[1] + g[2] * g[2];
  for (std::size_t n = 0; n < model.nodes.size(); ++n)
  {
    const double share = discretisation.weight_share.empty() ? 1.0 : double(discretisation.weight_share[n]);
    squared += 0.5 * discretisation.node_mass[n] * share * share * pull;
  }
  NodalLoads<double> loads(model, discretisation);
  const std::vector<double> rest(model.nodes.size(), 0);
  const double* const u[3] = { rest.data(), rest.data(), rest.data() };
  std::vector<float> activation(model.muscles.size(), 0);
  loads.update(1e300, activation, u);
  const auto ramped = loads.surface_forces();
  const auto push_beyond = [&](const std::vector<std::array<double, 3>>& others)
  {
    double pressed = 0;
    for (std::size_t l = 0; l < loads.nodes().size(); ++l)
      for (std::size_t axis = 0; axis < 3; ++axis)
      {
        const double f = loads.surface_forces()[l][axis] - others[l][axis];
        pressed += 0.5 * f * f / discretisation.node_mass[loads.nodes()[l]];
      }
    return std::sqrt(pressed);
  };
  push_ = std::sqrt(squared) + push_beyond(std::vector<std::array<double, 3>>(ramped.size()));
  for (const EnergySupply& body : supplies)
  {
    push_ += body.push;
    if (body.spring > 0 && body.bone >= 0)
      bones_.push_back({ body.bone, body.spring });
  }
  for (const Load& load : model.loads)
    if (load.activation >= 0)
    {
      activation[load.activation] = 1;
      loads.update(1e300, activation, u);
      activated_push_.emplace_back(load.activation, push_beyond(ramped));
      activation[load.activation] = 0;
    }
}

double EnergyBound::most(const Interval& interval) const
{
  double given = floor_ + stored_ + (viscous_ ? interval.largest_internal : 0);
  for (std::size_t m = 0; m < fibres_.size(); ++m)
    given += fibres_[m] *
             (active_stretch * double(interval.activation[m]) + (model_.muscles[m].passive ? passive_stretch : 0.0));
  for (const auto& bone : bones_)
  {
    const double moved = interval.bone_way[bone.index];
    given += 0.5 * bone.stiffness * moved * moved;
  }
  for (const auto& nodes : prescribed_)
  {
    const Load& load = model_.loads[nodes.index];
    const double part = physics::ramped(interval.end, load.ramp) - physics::ramped(interval.begin, load.ramp);
    const auto& d = load.value;
    // Without a ramp, nodes jump in the first step.
    const double share = interval.begin == 0 && load.ramp == 0 ? 1 : part;
    given += 0.5 * nodes.stiffness * share * share * (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
  }
  double push = push_;
  for (const auto& [activation, full] : activated_push_)
    push += double(interval.activation[activation]) * full;
  const double root = std::sqrt(interval.energy + given) + push * (interval.end - interval.begin);
  return margin * root * root;
}

}  // namespace frontalis
