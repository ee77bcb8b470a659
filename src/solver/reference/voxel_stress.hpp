#pragma once

#include "solver/stepping/discretisation.hpp"
#include "frontalis/physics/voxel_element.hpp"

#include <vector>

namespace frontalis
{

/// First Piola-Kirchhoff stress [Pa] of a voxel's materials, in double.
physics::Matrix3<double> elastic_stress(const VoxelProperties& voxel, double kappa,
                                        const physics::Kinematics<double>& k);

struct FibreState
{
  double stress;  ///< second Piola-Kirchhoff along the fibre times its weight [Pa]
  double stretch_squared;
};

/// Adds the stress of one fibre entry of the model: P += S (F a0) (x) a0.
FibreState add_fibre_stress(const Model& model, std::int32_t entry, const physics::Kinematics<double>& k,
                            const std::vector<float>& activation, EffectSet running, physics::Matrix3<double>& P);

}  // namespace frontalis
