#pragma once

#include "frontalis/model/model.hpp"

namespace frontalis
{

/// Settings of a curved shell like a forehead, made in code for benchmarks and tests without meshes. It is part of an
/// ellipsoid with layers (dermis, hypodermis) and a sheet of four overlapping muscles below them, with a tendon above
/// the muscles. Nodes are rigid near the shell's rim and slide on the bone elsewhere; skin and landmarks are bound.
/// Local x is up, y lateral, z outwards.
struct ShellSettings
{
  double voxel = 1e-3;              ///< edge [m]
  double density = 1100;            ///< [kg/m3]
  double stress_reference = 0.3e6;  ///< of the muscles [Pa]
  bool tendon = true;               ///< the tendon is stiff, so that it limits the time step
  double damping = 60;              ///< [1/s]
};

Model shell_model(const ShellSettings& settings);

}  // namespace frontalis
