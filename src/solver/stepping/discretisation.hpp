#pragma once

#include "frontalis/model/effects.hpp"
#include "frontalis/physics/assumed_strain.hpp"
#include "frontalis/physics/cut_voxels.hpp"
#include "solver/stepping/added_stiffness.hpp"
#include "solver/stepping/array_list.hpp"

#include <array>
#include <functional>
#include <memory>
#include <vector>

namespace frontalis
{

/// The part of a voxel that has a law other than neo-Hookean. Each material has a part of its own, but Mooney-Rivlin
/// materials, and likewise Fung materials, are averaged by their fractions, because means of their parameters, which
/// are moduli and stiffening exponents, are meaningful.
struct LawPart
{
  Law law;
  double weight;  ///< fraction of the voxel's tissue
  std::array<double, physics::parameter_slots> parameters;
  double stiffness_at_rest;  ///< tangent shear stiffness [Pa]
  /// factor from a tangent stiffness [Pa] to the voxel's stiffness [N/m]: weight times tissue volume divided by the
  /// square of the shortest edge [m]
  double per_tangent;
  std::int32_t material;  ///< -1: averaged from several materials
};

/// Properties of one voxel, mixed from its materials.
struct VoxelProperties
{
  double mu = 0;                                   ///< neo-Hookean shear modulus, mixed by fraction [Pa]
  double kappa = 0;                                ///< bulk modulus, mixed by fraction [Pa]
  double stiffening = 0;                           ///< of the neo-Hookean law, mixed by stiffness [-]
  double tissue_volume = 0;                        ///< volume times fill [m3]
  double density = 0;                              ///< mixed, after mass scaling [kg/m3]
  double hourglass = 0;                            ///< scalar stiffness against hourglass modes [N/m]
  physics::AssumedStrain<double> stabilisation{};  ///< [N m]; only with assumed-strain hourglass control
  /// Bound of the largest eigenvalue of the voxel's stiffness at rest, with every muscle at full activation [N/m].
  double stiffness = 0;
  physics::TissueCentre<double> centre{};  ///< point where the voxel's stress is computed
  std::vector<LawPart> laws;
  /// Prony terms as means over the materials: fractions weighted by stiffness, rates [1/s] weighted by the stiffness
  /// that relaxes.
  std::array<double, 2> viscous_share{};
  std::array<double, 2> viscous_rate{};
};

/// Bound of a material's tangent shear stiffness at rest [Pa], with fibres as if they were taut in all directions.
double shear_at_rest(const Material& material);

/// The properties of a model that every backend needs, in double precision. Properties of a voxel are computed on
/// request, because each backend stores them in a form of its own.
class Discretisation
{
public:
  /// The model must outlive this object. Throws Error if a voxel has no stiffness or no mass.
  explicit Discretisation(const Model& model);

  void voxel(std::size_t index, VoxelProperties& out) const;
  /// Computes the stiffness bounds with the running fibre effects. Masses do not change.
  void bound(EffectSet running);
  void list_arrays(ArrayList& list) const;
  /// Factor on the stiffness bound of a voxel at one of its corners.
  double factor_at(std::int32_t voxel, std::size_t corner) const
  {
    return corner_stiffness.empty() ? 1 : double(corner_stiffness[voxel][corner]);
  }
  /// The added stiffness of type `Stiffness`; null if the model has none.
  template <class Stiffness>
  const Stiffness* find_added() const
  {
    for (const auto& stiffness : added)
      if (const auto* const found = dynamic_cast<const Stiffness*>(stiffness.get()))
        return found;
    return nullptr;
  }

  double volume = 0;                         ///< volume of a voxel, whatever its fill [m3]
  bool assumed_strain = false;               ///< whether hourglass control is by assumed strain
  bool selective_reduced = false;            ///< whether integration replaces hourglass control
  bool laws = false;                         ///< whether a voxel has a law other than neo-Hookean
  int viscous_terms = 0;                     ///< 0..2
  double viscous_time_min = 0;               ///< [s]
  std::array<double, 3> hourglass_weight{};  ///< 1 / (4 sqrt(3) h) [1/m]
  std::array<double, 3> stretch_weight{};    ///< 1/h^2 divided by the sum over the three axes
  double stretch_half_sum = 0;               ///< half of that sum over the axes [1/m2]
  std::vector<double> node_mass;             ///< lumped [kg]
  /// Masses for the bound of the highest frequency. Over a group of attached nodes they add up to the same mass as
  /// node_mass; the mass of a node that does not move with its master is infinite. If the list is empty, node_mass
  /// applies.
  std::vector<double> bound_mass;
  /// A held node that follows a master: its displacement relative to the bone is `ratio` times the master's. At a
  /// joint the ratio is 1.
  struct Follower
  {
    std::int32_t node, master;
    double ratio;
  };
  std::vector<Follower> followers;
  std::vector<std::array<float, 8>> corner_stiffness;  ///< factors on the bounds of voxels at their corners; empty: 1
  std::vector<float> weight_share;                     ///< mass before mass scaling divided by node_mass; empty: 1
  std::vector<std::int32_t> held;                      ///< nodes whose motion is prescribed along all axes, ascending
  /// stiffness that the bounds include whether its effect runs or not
  std::vector<std::shared_ptr<AddedStiffness>> added;
  double frequency_squared_max = 0;  ///< bound of the highest frequency at rest [1/s2] (physics/time_step.hpp)

private:
  void mix(std::size_t index, VoxelProperties& out) const;
  void bound_at_rest();
  void share_masses();
  bool raises_least_masses() const
  {
    return model_->mass_scaling.kind == MassScalingSettings::Kind::uniform && !mass_factor_.empty();
  }

  const Model* model_;
  EffectSet running_;
  double least_hourglass_ = 0;      // of slivers [N/m]; 0: no such least stiffness
  std::vector<float> mass_factor_;  // one per voxel; empty without mass scaling
};

/// Calls visit(bone, place at rest [m]) for all nodes and points that bones hold, guide or may push.
void each_point_on_bones(const Model& model,
                         const std::function<void(std::int32_t bone, const std::array<double, 3>& at)>& visit);

/// The corner of the grid opposite to its origin [m].
inline std::array<double, 3> far_corner(const Model& model)
{
  const auto place = rest_place(model, { { model.size[0], model.size[1], model.size[2] } });
  const std::int32_t top = model.flaps.empty() ? place[2] : std::max(place[2], model.flaps.front().first - 1);
  return { { place[0] * model.spacing[0], place[1] * model.spacing[1], top * model.spacing[2] } };
}

}  // namespace frontalis
