#include "solver/energy/voxel_monitor.hpp"

#include "frontalis/physics/hourglass.hpp"
#include "frontalis/physics/materials/neo_hookean.hpp"
#include "frontalis/physics/selective_reduced.hpp"
#include "frontalis/physics/time_step.hpp"
#include "solver/material_laws.hpp"
#include "solver/energy/plane_monitor.hpp"
#include "solver/stepping/step_bound.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

using Kinematics = physics::Kinematics<double>;

// elastic energy a volume, the volumetric part by kappa
double elastic_energy(const VoxelProperties& voxel, double kappa, const Kinematics& k)
{
  double sum = physics::energy(physics::NeoHookean<double>{ voxel.mu, kappa }, k);
  for (const auto& part : voxel.laws)
    visit_law(part.law, part.parameters.data(),
              [&](const auto& material, const auto&... families)
              { sum += part.weight * physics::energy(material, k, families...); });
  return sum;
}

double hourglass_energy(const Discretisation& d, const VoxelProperties& voxel, const Kinematics& k,
                        const double (&mode)[3][8])
{
  if (d.assumed_strain)
    return physics::hourglass_energy(voxel.stabilisation, voxel.hourglass, d.hourglass_weight.data(), k.F, mode);
  double sum = 0;
  for (const auto& component : mode)
    for (int m = 0; m < 8; ++m)
      if (physics::is_hourglass_mode(m))
        sum += 0.5 * voxel.hourglass * component[m] * component[m];
  return sum;
}

}  // namespace

double stiffness_now(const Discretisation& d, const VoxelProperties& voxel, const Kinematics& k)
{
  const physics::NeoHookean<double> material{ voxel.mu * voxel.tissue_volume, voxel.kappa * voxel.tissue_volume };
  double stiffness =
      physics::voxel_stiffness_now(voxel.stiffness, material, k, d.stretch_weight.data(), d.stretch_half_sum);
  for (const auto& part : voxel.laws)
    stiffness += law_stiffening(part.law, part.parameters.data(), part.stiffness_at_rest, part.per_tangent, k);
  return stiffness;
}

Monitor monitor_of(const PlaneMonitor& sum, double frequency_squared, std::int32_t stiffest_voxel)
{
  Monitor result;
  result.kinetic = sum.kinetic;
  result.internal = sum.internal;
  result.hourglass = sum.hourglass;
  result.worst_jacobian = sum.worst_jacobian;
  result.worst_voxel = sum.worst_voxel;
  result.inverted = sum.inverted;
  result.critical_time_step = 2 / std::sqrt(frequency_squared);
  result.stiffest_voxel = stiffest_voxel;
  result.finite = std::isfinite(sum.kinetic) && std::isfinite(sum.internal) && std::isfinite(sum.hourglass);
  return result;
}

Monitor monitor_voxels(const Model& model, const Discretisation& d, const std::vector<std::array<double, 3>>& u,
                       const std::vector<std::array<double, 3>>& v)
{
  const auto& h = model.spacing;
  const double scale[3] = { 0.25 / h[0], 0.25 / h[1], 0.25 / h[2] };
  std::vector<double> stiffness(model.voxels.size(), 0);
  PlaneMonitor sum;
  for (std::size_t n = 0; n < v.size(); ++n)
    sum.kinetic += 0.5 * d.node_mass[n] * (v[n][0] * v[n][0] + v[n][1] * v[n][1] + v[n][2] * v[n][2]);
  VoxelProperties voxel;
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
  {
    d.voxel(e, voxel);
    double mode[3][8];
    for (int axis = 0; axis < 3; ++axis)
    {
      for (int b = 0; b < 8; ++b)
        mode[axis][b] = u[model.voxel_nodes[e][b]][axis];
      physics::walsh_hadamard(mode[axis]);
    }
    const auto k = physics::kinematics(mode[0], mode[1], mode[2], scale);
    const auto index = static_cast<std::int32_t>(e);
    PlaneMonitor own{ 0, 0, 0, k.J, 0, index };
    if (d.selective_reduced)
    {
      own.internal = voxel.tissue_volume * 0.5 * voxel.kappa * k.dilatation * k.dilatation;
      for (int point = 0; point < 8; ++point)
      {
        double moved[3][8];
        physics::at_gauss_point(point, mode, moved);
        const auto at_point = physics::kinematics(moved[0], moved[1], moved[2], scale);
        own.internal += 0.125 * voxel.tissue_volume * elastic_energy(voxel, 0, at_point);
        stiffness[e] = physics::larger_or_none(stiffness[e], stiffness_now(d, voxel, at_point));
        own.worst_jacobian = std::min(own.worst_jacobian, at_point.J);
      }
    }
    else
    {
      own.internal = voxel.tissue_volume * elastic_energy(voxel, voxel.kappa, k);
      own.hourglass = hourglass_energy(d, voxel, k, mode);
      stiffness[e] = stiffness_now(d, voxel, k);
    }
    own.inverted = own.worst_jacobian <= 0 ? 1 : 0;
    sum.add(own);
  }
  const StepBound bound = step_bound(d, model, stiffness);
  return monitor_of(sum, bound.frequency_squared, stiffest_voxel_at(model, bound.node, stiffness.data()));
}

}  // namespace frontalis
