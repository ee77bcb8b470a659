#pragma once

#include "frontalis/model/model.hpp"

#include <vector>

namespace frontalis
{

/// What every backend needs of a model, in double: mixed materials, masses, the time step at rest.
struct Discretisation
{
  explicit Discretisation(const Model& model);

  double volume = 0;  ///< of a whole voxel [m3]

  // one a voxel
  std::vector<double> mu;                 ///< mixed by proportion [Pa]
  std::vector<double> kappa;              ///< mixed by proportion [Pa]
  std::vector<double> tissue_volume;      ///< volume times fill [m3]
  std::vector<double> hourglass;          ///< stiffness on the hourglass modes [N/m]
  std::vector<double> density;            ///< mixed, after mass scaling [kg/m3]
  std::vector<double> frequency_squared;  ///< bound at rest with every muscle at full activation [1/s2]

  std::vector<double> node_mass;     ///< lumped [kg]
  double frequency_squared_max = 0;  ///< [1/s2]
  double mass_added = 0;             ///< by mass scaling, proportion of the unscaled mass
  std::vector<std::int32_t> scaled;  ///< voxels that mass scaling changed
};

}  // namespace frontalis
