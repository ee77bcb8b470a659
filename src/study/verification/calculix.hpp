#pragma once

#include "frontalis/solver/solver.hpp"
#include "frontalis/study/voxel_model.hpp"

#include <string>

namespace frontalis
{

/// A problem that both this solver and CalculiX can solve: a box of neo-Hookean materials, held and loaded.
struct SolidProblem
{
  /// Nodes for which `where` holds (position at rest [m]) get `displacement` [m] in the named components.
  struct Hold
  {
    std::function<bool(const std::array<double, 3>&)> where;
    std::array<bool, 3> components;
    std::function<std::array<double, 3>(const std::array<double, 3>&)> displacement;
  };
  std::array<double, 3> size;  ///< [m]
  std::vector<Material> materials;
  std::function<int(const std::array<double, 3>&)> material;  ///< at a point; empty: the first
  std::vector<Hold> holds;
  std::array<double, 3> gravity{ { 0, 0, 0 } };  ///< [m/s2]
};

/// Nodes of a solution: positions at rest [m], displacements [m], forces that hold them [N].
struct SolidState
{
  Vectors positions, displacements, forces;
};

bool calculix_is_there();

/// Solves the problem by CalculiX (program ccx) with elements[0] x [1] x [2] quadratic hexahedra (C3D20R),
/// hyperelastic, large deformation. Its neo-Hookean solid is ours with C10 = mu / 2 and D1 = 2 / kappa (CalculiX
/// manual, *HYPERELASTIC: U = C10 (I1 - 3) + (J - 1)^2 / D1 of the isochoric I1). Deck and output are in a temporary
/// folder that is removed afterwards. Throws Error with the end of its log if it fails.
SolidState solve_by_calculix(const SolidProblem& problem, const std::array<int, 3>& elements);

/// The same by voxels of edge `edge` [m], which divides the box; `period` as in EquilibriumSettings.
SolidState solve_by_voxels(const SolidProblem& problem, double edge, double period, const Backend& backend);

}  // namespace frontalis
