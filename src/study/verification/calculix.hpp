#pragma once

#include "frontalis/study/voxel_model.hpp"

#include <string>

namespace frontalis
{

/// A solution by CalculiX: for each node the displacement [m] and the force of the supports [N].
struct CalculixState
{
  Vectors displacements, forces;
};

/// Whether the program ccx is found. What to say if it is not.
bool calculix_is_installed();
inline constexpr const char* calculix_is_missing =
    "CalculiX (program ccx, Debian's package calculix-ccx) is not installed";

/// CalculiX's input for a neo-Hookean material with a name, in mm, MPa and t. CalculiX's solid equals ours with
/// C10 = mu / 2 and D1 = 2 / kappa (CalculiX manual, *HYPERELASTIC: U = C10 (I1 - 3) + (J - 1)^2 / D1 of the isochoric
/// I1).
std::string calculix_material(const std::string& name, const Material& material);

/// The step of large deformation in CalculiX's input, with the lines of its supports and loads; it prints the
/// displacements and forces of the set NALL.
std::string calculix_step(const std::string& supports_and_loads);

/// Solves an input file in mm, N, MPa and t, whose nodes are numbered from 1 to `nodes`, by CalculiX (program ccx).
/// Input and output are in a temporary folder that is removed afterwards. Throws Error with the end of CalculiX's log
/// if CalculiX fails.
CalculixState run_calculix(const std::string& deck, std::size_t nodes);

}  // namespace frontalis
