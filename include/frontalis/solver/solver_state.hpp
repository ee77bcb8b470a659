#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace frontalis
{

/// Published surface in the local frame [m].
struct SkinState
{
  /// Those that a film has added (SkinFilm::parents) lie on a smooth surface through those that follow the voxels.
  std::vector<std::array<float, 3>> vertices;
  /// Outward unit normals: area-weighted means over triangles, and of a solver's vertices that a film has added the
  /// means of those of their two neighbours.
  std::vector<std::array<float, 3>> normals;
  std::vector<std::array<float, 3>> landmarks;
  std::vector<float> line_height;  ///< of fine lines over the skin, per vertex [m]; empty without them (FineLines)
};

/// Quantities of the tissue below the skin, one number per vertex; computed only on request.
enum class SkinField
{
  strain,  ///< largest principal Green-Lagrange strain
  stress,  ///< von Mises stress [Pa] of the Cauchy stress of materials and fibres, without viscous stresses
  lines    ///< height of fine lines over the skin [m]; 0 in a solver, since FineLines adds the lines to frames later
};

/// Energies [J], summed in double precision, and the worst voxel: the one with the smallest J.
struct Monitor
{
  double kinetic = 0;
  double internal = 0;  ///< elastic strain energy of the materials, without fibres and hourglass control
  double hourglass = 0;
  double bodies = 0;          ///< kinetic energy of pushed bodies, and energy of their springs
  double worst_jacobian = 1;  ///< smallest J = det F of a voxel
  std::int32_t worst_voxel = -1;
  std::int64_t inverted = 0;         ///< voxels with J <= 0
  double critical_time_step = 0;     ///< present value from the bound at nodes [s] (physics/time_step.hpp)
  std::int32_t stiffest_voxel = -1;  ///< stiffest voxel at the node that sets the critical step
  double step_share = 0;  ///< latest time step divided by the present critical one (of the model's TimeStepEstimate)
  /// number of sliding nodes past the rim of their surface's field, which keep their latest tangent plane
  std::int64_t past_rim = 0;
  std::int32_t lost_node = -1;  ///< a node that is more than 4 mm past the rim; -1: none
  /// number of contact points deeper in a body than its field reaches, which nothing pushes out
  std::int64_t lost_points = 0;
  double added_mass = 0;  ///< mass that MassScalingSettings::in_motion has added, as a proportion of the model's mass
  bool finite = true;
};

/// One term of the energy ledger [J].
struct EnergyTerm
{
  enum class Kind : std::uint8_t
  {
    stored,  ///< present value
    lost,    ///< dissipated since the ledger was opened
    work     ///< done on the tissue since the ledger was opened
  };
  std::string name;
  Kind kind = Kind::stored;
  double value = 0;
};

/// Present energies and their sources [J], since reset or since displacements or velocities were set.
struct EnergyLedger
{
  double initial = 0;             ///< stored energy when the ledger was opened
  std::vector<EnergyTerm> terms;  ///< all terms of empty_ledger(), which documents them
  double largest = 0;             ///< largest magnitude of the terms and of `initial` so far

  /// Value of a term. Throws Error if there is none of this name.
  double& operator[](const std::string& name);
  double operator[](const std::string& name) const { return const_cast<EnergyLedger&>(*this)[name]; }

  /// Energy that the terms do not explain; it tends to 0 with the time step.
  double imbalance() const;
};

/// Result of a search for equilibrium.
struct Equilibrium
{
  bool reached = false;
  double residual = 0;  ///< estimated remaining motion divided by the displacement
  double seconds = 0;   ///< simulated time [s]
};

/// Wall seconds that the solver has spent since construction or reset.
struct Profile
{
  double stepping = 0;
  double skin = 0;
  double monitor = 0;
  std::int64_t steps = 0;
};

}  // namespace frontalis
