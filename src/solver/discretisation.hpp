#pragma once

#include "frontalis/model/model.hpp"
#include "frontalis/physics/assumed_strain.hpp"

#include <array>
#include <vector>

namespace frontalis
{

/// What every backend needs of a model, in double: mixed materials, masses, the time step at rest.
struct Discretisation
{
  explicit Discretisation(const Model& model);

  double volume = 0;  ///< of a whole voxel [m3]

  /// Share of a voxel that has another law than neo-Hookean: one a material, but materials of laws whose parameters are
  /// moduli and stiffenings (Mooney-Rivlin, Fung) are averaged by proportion.
  struct LawPart
  {
    Law law;
    double weight;  ///< proportion of the voxel's tissue
    std::array<double, 11> parameters;
    double stiffness_at_rest;  ///< tangent shear stiffness [Pa]
    std::int32_t material;     ///< -1: averaged
  };
  std::vector<std::int32_t> law_begin;  ///< parts of voxel e: law_begin[e] .. law_begin[e + 1]
  std::vector<LawPart> laws;

  // one a voxel
  std::vector<double> mu;             ///< neo-Hookean shear modulus, mixed by proportion [Pa]
  std::vector<double> kappa;          ///< mixed by proportion [Pa]
  std::vector<double> tissue_volume;  ///< volume times fill [m3]
  std::vector<double> hourglass;      ///< scalar stiffness on the hourglass modes [N/m]
  /// Assumed strain [N m]: bending, coupling, torsion, warping; empty with scalar hourglass control.
  std::array<std::vector<double>, 4> assumed_strain;
  std::array<double, 3> hourglass_weight{};  ///< 1 / (4 sqrt(3) h) [1/m]
  std::vector<double> density;               ///< mixed, after mass scaling [kg/m3]
  std::vector<double> frequency_squared;     ///< bound at rest with every muscle at full activation [1/s2]

  std::vector<double> node_mass;     ///< lumped [kg]
  double frequency_squared_max = 0;  ///< [1/s2]
  double mass_added = 0;             ///< by mass scaling, proportion of the unscaled mass
  std::vector<std::int32_t> scaled;  ///< voxels that mass scaling changed
};

/// The assumed-strain stiffnesses of a voxel; only where the model asks for them.
physics::AssumedStrain<double> stabilisation(const Discretisation& discretisation, std::size_t voxel);

}  // namespace frontalis
