#pragma once

#include "bake/mesh/surface_mesh.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace frontalis
{

/// Symmetric tensor: xx, yy, zz, xy, yz, zx.
using SymmetricTensor = std::array<double, 6>;
inline SymmetricTensor square(const Vector3& n)
{
  return { n[0] * n[0], n[1] * n[1], n[2] * n[2], n[0] * n[1], n[1] * n[2], n[2] * n[0] };
}

/// Cubic cells that fill a muscle's mesh: those that its surface passes through and those that they enclose. Strands
/// closer than a cell are joined and inner voids filled.
struct MuscleGrid
{
  /// A point of the surface that stands for the area around it.
  struct Sample
  {
    Vector3 point;
    Vector3 normal;
    double area = 0;         ///< [m2]
    std::int32_t cell = -1;  ///< -1: not in the part that is kept
  };

  Vector3 lower{ 0, 0, 0 };  ///< [m]
  double edge = 0;           ///< of a cell [m]
  std::vector<std::array<std::int32_t, 3>> cells;
  std::vector<std::array<std::int32_t, 8>> cell_nodes;  ///< corner b = i + 2j + 4k
  std::vector<std::array<std::int32_t, 3>> nodes;
  std::vector<Sample> samples;
  double kept = 1;  ///< proportion of the cells in the largest connected part, which alone is kept

  Vector3 cell_centre(std::size_t cell) const;
  Vector3 node_position(std::size_t node) const;
  /// Trilinear weights of a point in a cell's nodes.
  std::array<double, 8> weights(std::size_t cell, const Vector3& p) const;
};

/// Cells of such an edge that about `wanted` of them fill the mesh; times `coarser`.
MuscleGrid make_muscle_grid(const TriangleMesh& mesh, double wanted, double coarser = 1);

/// Averages tensors, one a cell, over about `reach` [m] within the muscle; beyond it they are 0.
void spread(const MuscleGrid& grid, double reach, std::vector<SymmetricTensor>& tensors);

}  // namespace frontalis
