#include "voxel_monitor.hpp"

#include "frontalis/physics/hourglass.hpp"
#include "frontalis/physics/neo_hookean.hpp"
#include "frontalis/physics/time_step.hpp"
#include "material_laws.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{

Monitor monitor_voxels(const Model& model, const Discretisation& d, const std::vector<std::array<double, 3>>& u,
                       const std::vector<std::array<double, 3>>& v)
{
  Monitor result;
  result.worst_jacobian = 1e300;
  const auto& h = model.spacing;
  const double scale[3] = { 0.25 / h[0], 0.25 / h[1], 0.25 / h[2] };
  const double shortest = std::min({ h[0], h[1], h[2] });
  double weight[3] = { 1 / (h[0] * h[0]), 1 / (h[1] * h[1]), 1 / (h[2] * h[2]) };
  const double sum = weight[0] + weight[1] + weight[2];
  for (double& w : weight)
    w /= sum;
  double frequency_squared = 0;
  for (std::size_t n = 0; n < v.size(); ++n)
    result.kinetic += 0.5 * d.node_mass[n] * (v[n][0] * v[n][0] + v[n][1] * v[n][1] + v[n][2] * v[n][2]);
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
  {
    double mode[3][8];
    for (int axis = 0; axis < 3; ++axis)
    {
      for (int b = 0; b < 8; ++b)
        mode[axis][b] = u[model.voxel_nodes[e][b]][axis];
      physics::walsh_hadamard(mode[axis]);
    }
    const auto k = physics::kinematics(mode[0], mode[1], mode[2], scale);
    if (!d.assumed_strain[0].empty())
      result.hourglass +=
          physics::hourglass_energy(stabilisation(d, e), d.hourglass[e], d.hourglass_weight.data(), k.F, mode);
    else
      for (const auto& component : mode)
        for (int m = 0; m < 8; ++m)
          if (physics::is_hourglass_mode(m))
            result.hourglass += 0.5 * d.hourglass[e] * component[m] * component[m];
    result.internal += d.tissue_volume[e] * physics::energy(physics::NeoHookean<double>{ d.mu[e], d.kappa[e] }, k);
    for (auto l = d.law_begin[e]; l < d.law_begin[e + 1]; ++l)
      visit_law(d.laws[l].law, d.laws[l].parameters.data(),
                [&](const auto& material, const auto&... families) {
                  result.internal += d.tissue_volume[e] * d.laws[l].weight * physics::energy(material, k, families...);
                });
    if (!(k.J >= result.worst_jacobian))
    {
      result.worst_jacobian = k.J;
      result.worst_voxel = static_cast<std::int32_t>(e);
    }
    const double growth = physics::stiffening(physics::NeoHookean<double>{ d.mu[e], d.kappa[e] }, k, weight);
    double squared = d.frequency_squared[e] * std::max(growth, 1.0);
    for (auto l = d.law_begin[e]; l < d.law_begin[e + 1]; ++l)
    {
      const double more = law_stiffness(d.laws[l].law, d.laws[l].parameters.data(), k) - d.laws[l].stiffness_at_rest;
      squared += 8 * d.laws[l].weight / (d.density[e] * shortest * shortest) * std::max(more, 0.0);
    }
    frequency_squared = std::max(frequency_squared, squared);
  }
  result.critical_time_step = 2 / std::sqrt(frequency_squared);
  result.finite = std::isfinite(result.kinetic) && std::isfinite(result.internal) && std::isfinite(result.hourglass);
  return result;
}

}  // namespace frontalis
