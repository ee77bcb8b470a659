#pragma once

#include "frontalis/physics/element/voxel_forces.hpp"
#include "solver/law_share.hpp"
#include "solver/stepping/discretisation.hpp"

#include <algorithm>

namespace frontalis
{

/// A voxel of the model in double precision, in the form that physics/element/ reads. The reference backend, the
/// monitor and the output fields use this class. Only fibres need `activation` and `running`; stresses do not need
/// `grid_scale`.
struct ModelVoxel
{
  const Model& model;
  const Discretisation& discretisation;
  const VoxelProperties& properties;
  std::size_t index;
  const std::vector<float>* activation = nullptr;  ///< one per muscle
  EffectSet running{};
  std::array<double, 3> grid_scale{};  ///< 1 / (4 h) [1/m]

  const double* scale() const { return grid_scale.data(); }
  const double* stretch_weight() const { return discretisation.stretch_weight.data(); }
  double stretch_half_sum() const { return discretisation.stretch_half_sum; }
  const double* hourglass_weight() const { return discretisation.hourglass_weight.data(); }
  bool assumed_strain() const { return discretisation.assumed_strain; }
  bool selective_reduced() const { return discretisation.selective_reduced; }
  physics::NeoHookean<double> material() const
  {
    return { properties.mu * properties.tissue_volume, properties.kappa * properties.tissue_volume,
             properties.stiffening };
  }
  double hourglass() const { return properties.hourglass; }
  double bound_at_rest() const { return properties.stiffness; }
  physics::AssumedStrain<double> stabilisation() const { return properties.stabilisation; }

  bool has_laws() const { return !properties.laws.empty(); }
  template <class Visit>
  void each_law(Visit&& visit) const
  {
    for (const LawPart& part : properties.laws)
    {
      LawShare<double> law{
        part.law, part.weight * properties.tissue_volume, part.stiffness_at_rest, part.per_tangent, {}
      };
      std::copy(part.parameters.begin(), part.parameters.end(), law.parameters);
      visit(law);
    }
  }
  void add_laws(const physics::Kinematics<double>& k, physics::Matrix3<double>& P) const
  {
    physics::add_laws(*this, k, P);
  }
  double law_stiffening(const physics::Kinematics<double>& k) const { return physics::law_stiffening(*this, k); }
  double stiffness_now(const physics::Kinematics<double>& k) const { return physics::stiffness_now(*this, k); }

  /// The fibres of one entry of the model's list of fibres.
  physics::Fibre<double, double> fibre(std::int32_t entry) const
  {
    const auto& a = model.fibre_direction[entry];
    const auto muscle = model.fibre_muscle[entry];
    const Muscle& m = model.muscles[muscle];
    return { { a[0], a[1], a[2] },
             model.fibre_weight[entry] * properties.tissue_volume * m.stress_reference,
             (*activation)[muscle],
             m.tension_length ? 1.0 : 0.0,
             m.passive && running.has(Effect::fibre_stiffness) };
  }
  template <class Visit>
  void each_fibre(Visit&& visit) const
  {
    for (auto entry = model.fibre_begin[index]; entry < model.fibre_begin[index + 1]; ++entry)
      visit(fibre(entry));
  }
};

}  // namespace frontalis
