#pragma once

#include "frontalis/model/model.hpp"

#include <vector>

namespace frontalis
{

struct ScaledVoxel
{
  double stiffness;  ///< bound [N/m]
  double mass;       ///< before scaling [kg]
  bool chosen;       ///< whether its mass may be increased
};

/// Returns a factor on each voxel's mass with which the chosen voxels allow the time step of the other voxels, or the
/// requested time step; empty if no mass changes. A chosen voxel adds to each of its nodes the mass that the voxel's
/// stiffness requires there (physics/time_step.hpp). `corner_stiffness`, `held`: as in Discretisation.
std::vector<float> selective_mass_factors(const Model& model, const std::vector<ScaledVoxel>& voxels,
                                          const std::vector<std::array<float, 8>>& corner_stiffness,
                                          const std::vector<std::int32_t>& held);

/// Part of a voxel. Corners of full tissue have 0.125 and get more, too; edges of it have 0.25.
constexpr double least_tissue = 0.2;

/// Gives nodes with little tissue around them the mass of `least_tissue` of a voxel of it, for models with scaled mass.
/// A single voxel that is nearly empty may otherwise set the time step as it is distorted, and its corners are thrown
/// by waves from the tissue around it. `node_mass`: lumped [kg].
void raise_least_masses(const Model& model, std::vector<double>& node_mass);

}  // namespace frontalis
