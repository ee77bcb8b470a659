#include "solver/reference/voxel_stress.hpp"

#include "frontalis/physics/muscle_fibre.hpp"
#include "frontalis/physics/materials/neo_hookean.hpp"
#include "solver/material_laws.hpp"

namespace frontalis
{

physics::Matrix3<double> elastic_stress(const VoxelProperties& voxel, double kappa,
                                        const physics::Kinematics<double>& k)
{
  const auto isotropic = physics::stress(physics::NeoHookean<double>{ voxel.mu, kappa }, k);
  physics::Matrix3<double> P;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      P.a[i][j] = isotropic.on_gradient * k.F.a[i][j] + isotropic.on_cofactor * k.cofactor.a[i][j];
  for (const auto& part : voxel.laws)
    add_law_stress(part.law, part.parameters.data(), part.weight, k, P);
  return P;
}

FibreState add_fibre_stress(const Model& model, std::int32_t entry, const physics::Kinematics<double>& k,
                            const std::vector<float>& activation, EffectSet running, physics::Matrix3<double>& P)
{
  const auto index = model.fibre_muscle[entry];
  const Muscle& muscle = model.muscles[index];
  const auto& a = model.fibre_direction[entry];
  double along[3];  // F a0
  double squared = 0;
  for (int i = 0; i < 3; ++i)
  {
    along[i] = k.F.a[i][0] * a[0] + k.F.a[i][1] * a[1] + k.F.a[i][2] * a[2];
    squared += along[i] * along[i];
  }
  const double S = model.fibre_weight[entry] *
                   physics::fibre_stress<double>(squared, k.J, muscle.stress_reference, activation[index],
                                                 muscle.tension_length ? 1 : 0,
                                                 muscle.passive && running.has(Effect::fibre_stiffness) ? 1 : 0);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      P.a[i][j] += S * along[i] * a[j];
  return { S, squared };
}

}  // namespace frontalis
