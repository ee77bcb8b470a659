#pragma once

#include "bake/mesh/surface_mesh.hpp"

namespace frontalis
{

/// Cubic cells that fill a muscle's mesh: those that its surface passes through and those that they enclose. Strands
/// closer than a cell become one, and voids inside are filled.
struct MuscleGrid
{
  /// A point of the surface that stands for the area around it.
  struct Sample
  {
    Vector3d point;
    Vector3d normal;
    double area = 0;         ///< [m2]
    std::int32_t cell = -1;  ///< -1: not in the part of the grid that is kept
  };

  Vector3d lower{ 0, 0, 0 };  ///< [m]
  double edge = 0;            ///< of a cell [m]
  std::vector<Eigen::Vector3i> cells;
  std::vector<std::array<std::int32_t, 8>> cell_nodes;  ///< corner b = i + 2j + 4k
  std::vector<Eigen::Vector3i> nodes;
  std::vector<Sample> samples;
  double kept = 1;  ///< proportion of all cells in the largest connected part, which alone is kept

  Vector3d cell_centre(std::size_t cell) const
  {
    return lower + edge * (cells[cell].cast<double>() + Vector3d::Constant(0.5));
  }
  Vector3d node_position(std::size_t node) const { return lower + edge * nodes[node].cast<double>(); }
  /// Box around all nodes.
  Box box() const;
  /// Trilinear weights of a point in the nodes of a cell.
  std::array<double, 8> weights(std::size_t cell, const Vector3d& p) const;
};

/// All places connected with `seed` by `steps`: take(place) says whether a place belongs and was not reached before.
template <class Place, class Take>
std::vector<Place> flood(const Place& seed, const std::vector<Place>& steps, const Take& take)
{
  std::vector<Place> reached{ seed };
  for (std::size_t front = 0; front < reached.size(); ++front)
    for (const Place& step : steps)
      if (const Place next = reached[front] + step; take(next))
        reached.push_back(next);
  return reached;
}

/// Chooses the edge of the cells such that about `wanted` of them fill the mesh, times `coarser`.
MuscleGrid make_muscle_grid(const TriangleMesh& mesh, double wanted, double coarser = 1);

/// Averages one tensor per cell over cells within about `reach` [m]; outside the muscle tensors count as 0.
void smooth(const MuscleGrid& grid, double reach, std::vector<Eigen::Matrix3d>& tensors);

}  // namespace frontalis
