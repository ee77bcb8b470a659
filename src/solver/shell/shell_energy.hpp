#pragma once

#include "frontalis/solver/shell_mesh.hpp"
#include "frontalis/solver/solver_state.hpp"

namespace frontalis
{

/// Adds the energy of shells at displacements `u` of nodes to the ledger. Also adds their forces on nodes [N] to
/// `forces`, unless that is empty.
template <class Real>
void add_shell_energies(const Model& model, const ShellMesh& mesh, const Real* const u[3],
                        std::vector<std::array<double, 3>>& forces, EnergyLedger& ledger);

}  // namespace frontalis
