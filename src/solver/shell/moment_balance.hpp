#pragma once

#include "solver/shell/shell_triangle.hpp"

#include <vector>

namespace frontalis
{

/// Changes the bending energies of a shell's triangles so that a uniform moment is in equilibrium: the forces that it
/// causes cancel at each vertex, as a patch test demands. Without this, they cancel only where triangles are regular,
/// and the shell gives way elsewhere, however small its triangles.
///
/// A triangle's energy 1/2 area b (1 + Z) b has a symmetric matrix Z, which is 0 before. At a vertex, equilibrium under
/// the three uniform bending vectors is three linear equations for the Z of about twelve triangles; that the energy of
/// a uniform curvature stays exact around the vertex is six more, for about six triangles. Each sweep meets these
/// equations at one vertex after the other by the least change of Z (Kaczmarz 1937), and then limits the norm of Z, so
/// that energies stay positive. These are projections onto convex sets.
///
/// At the edge of the shell only bending vectors are considered whose moment does not pass through the edge. Vertices
/// around which the edge has several directions are left as they are.
void balance_moments(std::vector<BentTriangle>& triangles, double poisson);

}  // namespace frontalis
