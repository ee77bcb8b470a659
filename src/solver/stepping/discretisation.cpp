#include "solver/stepping/discretisation.hpp"

#include "frontalis/error.hpp"
#include "frontalis/physics/hourglass.hpp"
#include "frontalis/physics/materials/lookup.hpp"
#include "frontalis/physics/muscle_fibre.hpp"
#include "frontalis/physics/time_step.hpp"
#include "solver/stepping/effect_parts.hpp"
#include "solver/stepping/mass_factors.hpp"
#include "solver/stepping/sliver_hourglass.hpp"
#include "solver/material_laws.hpp"
#include "solver/stepping/step_bound.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace frontalis
{
namespace
{

// Largest stiffness that the fibres of a voxel can add along one direction, with every muscle at full activation.
double fibre_stiffness(const Model& model, std::size_t voxel, EffectSet running)
{
  double sum = 0;
  for (auto f = model.fibre_begin[voxel]; f < model.fibre_begin[voxel + 1]; ++f)
  {
    const Muscle& muscle = model.muscles[model.fibre_muscle[f]];
    const double active = muscle.tension_length ? physics::active_slope_bound : 1.0;
    const double bound = muscle.passive && running.has(Effect::fibre_stiffness)
                             ? physics::active_slope_bound + physics::passive_slope_bound
                         : running.has(Effect::contraction) ? active
                                                            : 0.0;
    sum += bound * muscle.stress_reference * model.fibre_weight[f];
  }
  return sum;
}

// Parameters of a material in a voxel, with the voxel's own fibre directions if it has any.
physics::MaterialNumbers parameters_in(const Model& model, std::size_t voxel, const Material& material)
{
  auto parameters = material.parameters;
  for (int family = 0; family < physics::description_of(material.law).directions; ++family)
    if (!model.material_directions.empty())
    {
      const float* const d = model.material_directions[voxel].data() + 3 * family;
      if (d[0] != 0 || d[1] != 0 || d[2] != 0)
        std::copy(d, d + 3, parameters.begin() + physics::first_direction + 3 * family);
    }
  return parameters;
}

// Adds a material to that part of the voxel that has the material's law.
void add_law(const Model& model, std::size_t voxel, std::int32_t index, double proportion, std::vector<LawPart>& parts)
{
  const Material& material = model.materials[static_cast<std::size_t>(index)];
  const auto parameters = parameters_in(model, voxel, material);
  const std::int32_t key = physics::description_of(material.law).averaged ? -1 : index;
  auto part = std::find_if(parts.begin(), parts.end(),
                           [&](const auto& p) { return p.law == material.law && p.material == key; });
  if (part == parts.end())
    part = parts.insert(parts.end(), { material.law, 0, {}, 0, 0, key });
  const double before = part->weight;
  part->weight += proportion;
  for (std::size_t p = 0; p < part->parameters.size(); ++p)
    part->parameters[p] = (before * part->parameters[p] + proportion * parameters[p]) / part->weight;
}

physics::Kinematics<double> at_rest()
{
  const double none[8] = {}, scale[3] = {};
  return physics::kinematics(none, none, none, scale);
}

}  // namespace

double shear_at_rest(const Material& material)
{
  return material.law == Law::neo_hookean ? material.parameters[0]
                                          : law_stiffness(material.law, material.parameters.data(), at_rest());
}

namespace
{

bool contains_any(const Model& model, std::size_t voxel, const std::vector<std::int32_t>& materials)
{
  for (auto m = model.mixture_begin[voxel]; m < model.mixture_begin[voxel + 1]; ++m)
    if (model.mixture_proportion[m] > 0 &&
        std::find(materials.begin(), materials.end(), model.mixture_material[m]) != materials.end())
      return true;
  return false;
}

// Returns the rigid nodes, and the nodes whose displacement is prescribed along every axis. Returns an empty list if
// these are all nodes of the model, so that a model that cannot move has a time step too.
std::vector<std::int32_t> held_nodes(const Model& model)
{
  std::vector<int> directions(model.nodes.size(), 0);
  for (const auto& node : model.prescribed)
    for (int axis = 0; axis < 3; ++axis)
      if (model.loads[node.load].fixed[axis])
        directions[node.node] |= 1 << axis;
  for (const auto& node : model.rigid)
    directions[node.node] = 7;
  std::vector<std::int32_t> held;
  for (std::size_t n = 0; n < directions.size(); ++n)
    if (directions[n] == 7)
      held.push_back(static_cast<std::int32_t>(n));
  return held.size() < directions.size() ? held : std::vector<std::int32_t>();
}

void mix_viscosity(const Model& model, std::size_t voxel, VoxelProperties& out)
{
  double stiffness = 0;
  for (auto m = model.mixture_begin[voxel]; m < model.mixture_begin[voxel + 1]; ++m)
  {
    const Material& material = model.materials[model.mixture_material[m]];
    const double part = model.mixture_proportion[m] * physics::shear_modulus_of(material.law, material.parameters);
    stiffness += part;
    for (std::size_t term = 0; term < 2; ++term)
      if (material.viscous_share[term] > 0)
      {
        out.viscous_share[term] += part * material.viscous_share[term];
        out.viscous_rate[term] += part * material.viscous_share[term] / material.viscous_time[term];
      }
  }
  for (std::size_t term = 0; term < 2; ++term)
    if (out.viscous_share[term] > 0)
    {
      out.viscous_rate[term] /= out.viscous_share[term];
      out.viscous_share[term] /= stiffness;
    }
}

}  // namespace

Discretisation::Discretisation(const Model& model)
    : assumed_strain(model.hourglass == HourglassControl::assumed_strain),
      selective_reduced(model.integration == Integration::selective_reduced),
      held(held_nodes(model)),
      model_(&model),
      running_(effects_of(model))
{
  const auto& h = model.spacing;
  volume = h[0] * h[1] * h[2];
  double sum = 0;
  for (const double edge : h)
    sum += 1 / (edge * edge);
  stretch_half_sum = 0.5 * sum;
  for (int axis = 0; axis < 3; ++axis)
  {
    hourglass_weight[axis] = 0.25 / (std::sqrt(3.0) * h[axis]);
    stretch_weight[axis] = 1 / (h[axis] * h[axis]) / sum;
  }
  assumed_strain = assumed_strain && !selective_reduced;
  for (const Material& material : model.materials)
    for (int term = 0; term < 2 && running_.has(Effect::viscosity); ++term)
      if (material.viscous_share[term] > 0)
      {
        viscous_terms = std::max(viscous_terms, term + 1);
        const double time = material.viscous_time[term];
        viscous_time_min = viscous_time_min > 0 ? std::min(viscous_time_min, time) : time;
      }
  added = added_stiffness(model, *this);
  // Gauss points, assumed strain and tissue centres give hourglass modes stiffness of their own.
  if (!assumed_strain && !selective_reduced && model.tissue_centre.empty())
    least_hourglass_ = least_hourglass(model);
  VoxelProperties v;
  const EffectSet running = std::exchange(running_, EffectSet());  // the stiffness here is that without fibres
  for (std::size_t e = 0; e < model.tissue_centre.size(); ++e)
  {
    mix(e, v);
    // Largest eigenvalue of hourglass control: eight times the scalar stiffness, or at most twice that with assumed
    // strain.
    const double hourglass = assumed_strain ? 16 * v.hourglass / physics::assumed_strain_floor : 8 * v.hourglass;
    corner_stiffness.push_back(physics::corner_stiffness(v.centre, hourglass / v.stiffness));
  }
  running_ = running;
  const MassScalingSettings& scaling = model.mass_scaling;
  if (scaling.kind == MassScalingSettings::Kind::uniform && scaling.factor != 1)
    mass_factor_.assign(model.voxels.size(), static_cast<float>(scaling.factor));
  if (scaling.kind == MassScalingSettings::Kind::selective)
  {
    std::vector<ScaledVoxel> voxels;
    for (std::size_t e = 0; e < model.voxels.size(); ++e)
    {
      mix(e, v);
      voxels.push_back({ v.stiffness, v.density * v.tissue_volume,
                         scaling.materials.empty() || contains_any(model, e, scaling.materials) });
    }
    mass_factor_ = selective_mass_factors(model, voxels, corner_stiffness, held);
  }

  node_mass.assign(model.nodes.size(), 0);
  std::vector<double> weight(mass_factor_.empty() ? 0 : model.nodes.size(), 0.0);
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
  {
    voxel(e, v);
    laws = laws || !v.laws.empty();
    const double mass = v.density * v.tissue_volume;
    for (const auto node : model.voxel_nodes[e])
    {
      node_mass[node] += mass / 8;
      if (!weight.empty())
        weight[node] += mass / double(mass_factor_[e]) / 8;
    }
  }
  if (raises_least_masses())
    raise_least_masses(model, node_mass);
  for (std::size_t n = 0; n < weight.size(); ++n)
    weight_share.push_back(static_cast<float>(weight[n] / node_mass[n]));
  if (!model.attached.empty())
    share_masses();
  for (const Model::Joint& joint : model.joints)
    followers.push_back({ joint.node, joint.master, 1 });
  bound_at_rest();
  if (added.empty())
    return;
  for (const auto& stiffness : added)
    stiffness->stiffen(model, *this);
  bound_at_rest();
}

// Adds inertia to attached nodes that slide and would shorten the time step. Such a node may have a higher frequency
// than all free nodes if it has little tissue, such as a sliver of tendon below a bone's surface. It gets at most the
// mass of `least_tissue`. Then finds bound_mass. A held node follows its master, so that only the sums of stiffness and
// mass over their group count; within a group bound_mass is in proportion to stiffness.
void Discretisation::share_masses()
{
  std::vector<double> stiffness(node_mass.size(), 0), tissue(node_mass.size(), 0);
  VoxelProperties v;
  for (std::size_t e = 0; e < model_->voxels.size(); ++e)
  {
    mix(e, v);
    for (std::size_t corner = 0; corner < 8; ++corner)
    {
      const std::int32_t node = model_->voxel_nodes[e][corner];
      stiffness[node] += v.stiffness * factor_at(static_cast<std::int32_t>(e), corner);
      tissue[node] += double(model_->fill[e]) / 8;
    }
  }
  std::vector<bool> free(node_mass.size(), true);
  for (const AttachedNode& node : model_->attached)
    free[node.node] = false;
  for (const std::int32_t node : held)
    free[node] = false;
  double highest = 0, raised = raises_least_masses() ? least_tissue : 0;
  for (std::size_t n = 0; n < free.size(); ++n)
    highest = free[n] ? std::max(highest, stiffness[n] / node_mass[n]) : highest;
  for (const AttachedNode& node : model_->attached)
  {
    double& mass = node_mass[node.node];
    const double wanted =
        std::min(stiffness[node.node] / highest, least_tissue * mass / std::max(raised, tissue[node.node]));
    if (node.surface < 0 || !(wanted > mass))
      continue;
    weight_share.resize(node_mass.size(), 1);
    weight_share[node.node] *= static_cast<float>(mass / wanted);
    mass = wanted;
  }

  bound_mass = node_mass;
  std::vector<double> group_stiffness = stiffness;
  std::vector<double>& group_mass = tissue;
  group_mass = node_mass;
  for (const AttachedNode& node : model_->attached)
    if (node.surface < 0)
    {
      followers.push_back({ node.node, node.master, node.ratio });
      group_stiffness[node.master] += node.ratio * node.ratio * stiffness[node.node];
      group_mass[node.master] += node.ratio * node.ratio * node_mass[node.node];
    }
  for (const AttachedNode& node : model_->attached)
    if (node.surface < 0)
    {
      const double mass_per_stiffness = group_mass[node.master] / group_stiffness[node.master];
      bound_mass[node.master] = mass_per_stiffness * stiffness[node.master];
      bound_mass[node.node] =
          node.ratio == 0 ? std::numeric_limits<double>::infinity() : mass_per_stiffness * stiffness[node.node];
    }
}

void Discretisation::mix(std::size_t e, VoxelProperties& out) const
{
  const Model& model = *model_;
  const auto& h = model.spacing;
  out.mu = out.kappa = out.stiffening = out.density = 0;
  out.viscous_share = out.viscous_rate = {};
  out.laws.clear();
  for (auto m = model.mixture_begin[e]; m < model.mixture_begin[e + 1]; ++m)
  {
    const Material& material = model.materials[model.mixture_material[m]];
    const double proportion = model.mixture_proportion[m];
    if (material.law == Law::neo_hookean)
    {
      const double mu = proportion * material.parameters[0];
      out.mu += mu;
      out.stiffening += mu * material.parameters[physics::slot_of(1)];
    }
    else if (proportion > 0)
      add_law(model, e, model.mixture_material[m], proportion, out.laws);
    out.kappa += proportion * material.parameters[1];
    out.density += proportion * material.density;
  }
  out.stiffening = out.mu > 0 ? out.stiffening / out.mu : 0;
  double shear = out.mu;
  for (auto& part : out.laws)
  {
    part.stiffness_at_rest = law_stiffness(part.law, part.parameters.data(), at_rest());
    shear += part.weight * part.stiffness_at_rest;
  }
  if (!(shear > 0 && out.kappa > 0 && out.density > 0 && model.fill[e] > 0))
    throw Error(fmt::format("voxel {}: shear modulus, bulk modulus, density and fill must be positive", e));
  out.tissue_volume = volume * model.fill[e];
  const double shortest = std::min({ h[0], h[1], h[2] });
  for (auto& part : out.laws)
    part.per_tangent = part.weight * out.tissue_volume / (shortest * shortest);
  out.hourglass = physics::hourglass_stiffness(physics::young_modulus(shear, out.kappa), out.tissue_volume,
                                               std::max({ h[0], h[1], h[2] }));
  if (const double modes = physics::voxel_stiffness(shear, out.kappa, 0.0, out.tissue_volume, h[0], h[1], h[2]);
      least_hourglass_ > 0)
    out.hourglass = std::max(out.hourglass, sliver_hourglass(double(model.fill[e]), least_hourglass_, modes));
  if (assumed_strain)
  {
    out.stabilisation = physics::assumed_strain(shear, out.kappa, out.tissue_volume);
    out.hourglass *= physics::assumed_strain_floor;
  }
  else if (selective_reduced)
    out.hourglass = 0;
  out.stiffness = physics::voxel_stiffness(shear, out.kappa, fibre_stiffness(model, e, running_), out.tissue_volume,
                                           h[0], h[1], h[2]);
  for (const auto& stiffness : added)
    out.stiffness += stiffness->in_voxel(e);
  out.centre = {};
  if (!model.tissue_centre.empty())
    out.centre = { model.tissue_centre[e][0], model.tissue_centre[e][1], model.tissue_centre[e][2] };
  if (viscous_terms > 0)
    mix_viscosity(model, e, out);
}

void Discretisation::bound(EffectSet running)
{
  running_ = running;
  bound_at_rest();
}

void Discretisation::bound_at_rest()
{
  std::vector<double> stiffness(model_->voxels.size());
  VoxelProperties v;
  for (std::size_t e = 0; e < stiffness.size(); ++e)
  {
    mix(e, v);
    stiffness[e] = v.stiffness;
  }
  frequency_squared_max = step_bound(*this, *model_, stiffness, mobility(*this)).frequency_squared;
}

void Discretisation::list_arrays(ArrayList& list) const
{
  list.add("masses of nodes", node_mass);
  list.add(Effect::attachment, "masses of nodes", bound_mass);
  list.add("held nodes", held);
  list.add("shares of weight", weight_share);
  list.add("mass scaling", mass_factor_);
}

void Discretisation::voxel(std::size_t e, VoxelProperties& out) const
{
  mix(e, out);
  if (!mass_factor_.empty())
    out.density *= double(mass_factor_[e]);
}

void each_point_on_bones(const Model& model,
                         const std::function<void(std::int32_t bone, const std::array<double, 3>& at)>& visit)
{
  const auto moves = [&](std::int32_t bone, const std::array<double, 3>& p)
  {
    if (bone >= 0)
      visit(bone, p);
  };
  for (const RigidNode& node : model.rigid)
    moves(node.bone, rest_position(model, node.node));
  for (const SlidingNode& node : model.sliding)
    moves(model.constraint_surfaces[node.surface].bone, rest_position(model, node.node));
  for (const AttachedNode& node : model.attached)
    moves(node.surface >= 0 ? model.constraint_surfaces[node.surface].bone : node.bone,
          rest_position(model, node.node));
  for (const Contact& contact : model.contacts)
    for (const auto& point : contact.points)
      moves(contact.bone, point);
}

}  // namespace frontalis
