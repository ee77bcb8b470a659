#include "solver/stepping/mass_factors.hpp"

#include <algorithm>

namespace frontalis
{
namespace
{

// Squared frequency bound [1/s2] of a model that consists of the voxels whose mass stays as it is (ScaledVoxel::chosen
// is false). Held nodes count only if all nodes of these voxels are held. Factors at the corners of cut voxels raise
// the bound but hardly the true frequency, so that they count only if the bound sets the time step.
double allowed_by_others(const Model& model, const std::vector<ScaledVoxel>& voxels,
                         const std::vector<std::array<float, 8>>& corner_stiffness,
                         const std::vector<std::int32_t>& held)
{
  std::vector<double> stiffness(model.nodes.size(), 0), mass(model.nodes.size(), 0);
  const bool by_corner = !corner_stiffness.empty() && model.time_step_estimate == TimeStepEstimate::element;
  for (std::size_t e = 0; e < voxels.size(); ++e)
    for (std::size_t corner = 0; corner < 8 && !voxels[e].chosen; ++corner)
    {
      const std::int32_t n = model.voxel_nodes[e][corner];
      stiffness[n] += voxels[e].stiffness * (by_corner ? double(corner_stiffness[e][corner]) : 1.0);
      mass[n] += voxels[e].mass / 8;
    }
  const auto largest = [&]
  {
    double squared = 0;
    for (std::size_t n = 0; n < mass.size(); ++n)
      if (stiffness[n] > 0)
        squared = std::max(squared, stiffness[n] / mass[n]);
    return squared;
  };
  const double of_all = largest();
  for (const auto n : held)
    stiffness[n] = 0;
  const double of_free = largest();
  return of_free > 0 ? of_free : of_all;
}

}  // namespace

std::vector<float> selective_mass_factors(const Model& model, const std::vector<ScaledVoxel>& voxels,
                                          const std::vector<std::array<float, 8>>& corner_stiffness,
                                          const std::vector<std::int32_t>& held)
{
  const MassScalingSettings& settings = model.mass_scaling;
  const double allowed = settings.time_step > 0 ? 4 * model.time_step_share * model.time_step_share /
                                                      (settings.time_step * settings.time_step)
                                                : allowed_by_others(model, voxels, corner_stiffness, held);
  if (allowed == 0)
    return {};
  std::vector<float> factors;
  bool any = false;
  for (std::size_t e = 0; e < voxels.size(); ++e)
  {
    const ScaledVoxel& voxel = voxels[e];
    const double corner =
        corner_stiffness.empty() ? 1 : *std::max_element(corner_stiffness[e].begin(), corner_stiffness[e].end());
    const double factor = voxel.chosen ? std::max(8 * corner * voxel.stiffness / (allowed * voxel.mass), 1.0) : 1;
    factors.push_back(static_cast<float>(factor));
    any = any || factor > 1;
  }
  return any ? factors : std::vector<float>();
}

void raise_least_masses(const Model& model, std::vector<double>& node_mass)
{
  std::vector<double> tissue(node_mass.size(), 0);
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
    for (const std::int32_t node : model.voxel_nodes[e])
      tissue[node] += double(model.fill[e]) / 8;
  for (std::size_t n = 0; n < node_mass.size(); ++n)
    node_mass[n] *= std::max(1.0, least_tissue / tissue[n]);
}

}  // namespace frontalis
