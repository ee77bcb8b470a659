#pragma once

#include "frontalis/model/model.hpp"

#include <vector>

namespace frontalis
{

/// What mass scaling needs of a voxel.
struct ScaledVoxel
{
  double stiffness;  ///< bound [N/m]
  double mass;       ///< before it is scaled [kg]
  bool chosen;       ///< may get mass
};

/// Factor on each voxel's mass with which the chosen voxels allow the time step that the others allow by themselves, or
/// the one that is wanted; empty: none is scaled. A chosen voxel brings to each of its nodes the mass that its own
/// stiffness needs there (physics/time_step.hpp). held: Discretisation::held.
std::vector<float> selective_mass_factors(const Model& model, const std::vector<ScaledVoxel>& voxels,
                                          const std::vector<std::int32_t>& held);

}  // namespace frontalis
