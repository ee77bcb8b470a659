#include "discretisation.hpp"

#include "frontalis/error.hpp"
#include "frontalis/physics/hourglass.hpp"
#include "frontalis/physics/muscle_fibre.hpp"
#include "frontalis/physics/time_step.hpp"
#include "material_laws.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

// stiffness that the fibres of a voxel can add along one direction, every muscle at full activation
double fibre_stiffness(const Model& model, std::size_t voxel)
{
  double sum = 0;
  for (auto f = model.fibre_begin[voxel]; f < model.fibre_begin[voxel + 1]; ++f)
  {
    const Muscle& muscle = model.muscles[model.fibre_muscle[f]];
    const double slope = (muscle.tension_length ? physics::active_slope_bound : 1.0) +
                         (muscle.passive ? physics::passive_slope_bound : 0.0);
    sum += slope * muscle.stress_reference * model.fibre_weight[f];
  }
  return sum;
}

// a material's parameters in a voxel: with the voxel's own directions where it has some
std::array<double, 11> parameters_in(const Model& model, std::size_t voxel, const Material& material)
{
  auto parameters = material.parameters;
  if ((material.law == Law::holzapfel || material.law == Law::guccione) && !model.material_directions.empty())
    for (int family = 0; family < 2; ++family)
    {
      const float* const d = model.material_directions[voxel].data() + 3 * family;
      if (d[0] != 0 || d[1] != 0 || d[2] != 0)
        std::copy(d, d + 3, parameters.begin() + first_direction + 3 * family);
    }
  return parameters;
}

// adds a material to the part of its law
void add_law(const Model& model, std::size_t voxel, std::int32_t index, double proportion,
             std::vector<Discretisation::LawPart>& parts, std::size_t first)
{
  const Material& material = model.materials[static_cast<std::size_t>(index)];
  const auto parameters = parameters_in(model, voxel, material);
  // exponents and directions have no mean
  const bool averaged = material.law == Law::mooney_rivlin || material.law == Law::fung;
  const std::int32_t key = averaged ? -1 : index;
  auto part = std::find_if(parts.begin() + static_cast<std::ptrdiff_t>(first), parts.end(),
                           [&](const auto& p) { return p.law == material.law && p.material == key; });
  if (part == parts.end())
    part = parts.insert(parts.end(), { material.law, 0, {}, 0, key });
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

bool contains_any(const Model& model, std::size_t voxel, const std::vector<std::int32_t>& materials)
{
  for (auto m = model.mixture_begin[voxel]; m < model.mixture_begin[voxel + 1]; ++m)
    if (model.mixture_proportion[m] > 0 &&
        std::find(materials.begin(), materials.end(), model.mixture_material[m]) != materials.end())
      return true;
  return false;
}

// gives voxels mass as the model's settings say; frequencies follow
void scale_mass(const Model& model, Discretisation& d)
{
  const MassScalingSettings& settings = model.mass_scaling;
  std::vector<double> factor(model.voxels.size(), 1.0);
  if (settings.kind == MassScalingSettings::Kind::uniform)
    std::fill(factor.begin(), factor.end(), settings.factor);
  else if (settings.kind == MassScalingSettings::Kind::selective)
  {
    double allowed = 0;
    std::vector<bool> chosen(model.voxels.size());
    for (std::size_t e = 0; e < model.voxels.size(); ++e)
    {
      chosen[e] = contains_any(model, e, settings.materials);
      if (!chosen[e])
        allowed = std::max(allowed, d.frequency_squared[e]);
    }
    if (allowed > 0)
      for (std::size_t e = 0; e < model.voxels.size(); ++e)
        if (chosen[e] && d.frequency_squared[e] > allowed)
          factor[e] = d.frequency_squared[e] / allowed;
  }
  double before = 0, after = 0;
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
  {
    before += d.density[e] * d.tissue_volume[e];
    d.density[e] *= factor[e];
    d.frequency_squared[e] /= factor[e];
    after += d.density[e] * d.tissue_volume[e];
    if (factor[e] != 1)
      d.scaled.push_back(static_cast<std::int32_t>(e));
  }
  d.mass_added = after / before - 1;
}

}  // namespace

physics::AssumedStrain<double> stabilisation(const Discretisation& discretisation, std::size_t voxel)
{
  const auto& parts = discretisation.assumed_strain;
  return { parts[0][voxel], parts[1][voxel], parts[2][voxel], parts[3][voxel] };
}

Discretisation::Discretisation(const Model& model)
{
  const auto& h = model.spacing;
  const double longest = std::max({ h[0], h[1], h[2] });
  const std::size_t count = model.voxels.size();
  volume = h[0] * h[1] * h[2];
  for (int axis = 0; axis < 3; ++axis)
    hourglass_weight[axis] = 0.25 / (std::sqrt(3.0) * h[axis]);
  for (auto* array : { &mu, &kappa, &tissue_volume, &hourglass, &density, &frequency_squared })
    array->assign(count, 0);
  law_begin.assign(1, 0);
  for (std::size_t e = 0; e < count; ++e)
  {
    for (auto m = model.mixture_begin[e]; m < model.mixture_begin[e + 1]; ++m)
    {
      const Material& material = model.materials[model.mixture_material[m]];
      const double proportion = model.mixture_proportion[m];
      if (material.law == Law::neo_hookean)
        mu[e] += proportion * material.parameters[0];
      else if (proportion > 0)
        add_law(model, e, model.mixture_material[m], proportion, laws, static_cast<std::size_t>(law_begin[e]));
      kappa[e] += proportion * material.parameters[1];
      density[e] += proportion * material.density;
    }
    law_begin.push_back(static_cast<std::int32_t>(laws.size()));
    double shear = mu[e];
    for (auto l = law_begin[e]; l < law_begin[e + 1]; ++l)
    {
      laws[l].stiffness_at_rest = law_stiffness(laws[l].law, laws[l].parameters.data(), at_rest());
      shear += laws[l].weight * laws[l].stiffness_at_rest;
    }
    if (!(shear > 0 && kappa[e] > 0 && density[e] > 0 && model.fill[e] > 0))
      throw Error("voxel " + std::to_string(e) + ": shear modulus, bulk modulus, density and fill must be positive");
    tissue_volume[e] = volume * model.fill[e];
    hourglass[e] = physics::hourglass_stiffness(physics::young_modulus(shear, kappa[e]), tissue_volume[e], longest);
    if (model.hourglass == HourglassControl::assumed_strain)
    {
      const auto k = physics::assumed_strain(shear, kappa[e], tissue_volume[e]);
      const double parts[4] = { k.bending, k.coupling, k.torsion, k.warping };
      for (int part = 0; part < 4; ++part)
        assumed_strain[part].push_back(parts[part]);
      hourglass[e] *= physics::assumed_strain_floor;
    }
    frequency_squared[e] =
        physics::frequency_squared_bound(shear, kappa[e], fibre_stiffness(model, e), density[e], h[0], h[1], h[2]);
  }
  scale_mass(model, *this);

  node_mass.assign(model.nodes.size(), 0);
  for (std::size_t e = 0; e < count; ++e)
  {
    frequency_squared_max = std::max(frequency_squared_max, frequency_squared[e]);
    for (const auto node : model.voxel_nodes[e])
      node_mass[node] += density[e] * tissue_volume[e] / 8;
  }
}

}  // namespace frontalis
