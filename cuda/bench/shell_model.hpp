#pragma once

#include "frontalis/model/model.hpp"

namespace frontalis
{

/// A curved shell like a forehead, made in code for benchmarks and tests without meshes: part of an ellipsoid with
/// layers (dermis, hypodermis), four overlapping muscles in a sheet below them with a tendon above. Nodes are rigid
/// near its rim and slide on the bone elsewhere; skin and landmarks are bound. Local x is up, y lateral, z outwards.
struct ShellSettings
{
  double voxel = 1e-3;              ///< edge [m]
  double density = 1100;            ///< [kg/m3]
  double stress_reference = 0.3e6;  ///< of the muscles [Pa]
  bool tendon = true;               ///< stiff: it limits the time step
  double damping = 60;              ///< [1/s]
};

Model shell_model(const ShellSettings& settings);

}  // namespace frontalis
