#pragma once

#include "bake/mesh/surface_mesh.hpp"

namespace frontalis
{

/// Cubic cells that fill a muscle's mesh: the cells that its surface passes through and those enclosed by them. Strands
/// closer to each other than a cell merge, and voids are filled.
struct MuscleGrid
{
  /// A point of the surface that represents the area around it.
  struct Sample
  {
    Vector3d point;
    Vector3d normal;
    double area = 0;         ///< [m2]
    std::int32_t cell = -1;  ///< -1: its cell was removed from the grid
  };

  Vector3d lower{ 0, 0, 0 };  ///< lower corner of the grid [m]
  double edge = 0;            ///< of a cell [m]
  std::vector<Eigen::Vector3i> cells;
  std::vector<std::array<std::int32_t, 8>> cell_nodes;  ///< nodes of each cell; corner b = i + 2j + 4k
  std::vector<Eigen::Vector3i> nodes;
  std::vector<Sample> samples;
  double kept = 1;  ///< proportion of cells in the largest connected component; the others were removed

  Vector3d cell_centre(std::size_t cell) const
  {
    return lower + edge * (cells[cell].cast<double>() + Vector3d::Constant(0.5));
  }
  Vector3d node_position(std::size_t node) const { return lower + edge * nodes[node].cast<double>(); }
  Box box() const;
  /// Trilinear shape functions of a cell's nodes at a point.
  std::array<double, 8> weights(std::size_t cell, const Vector3d& p) const;
};

/// Flood fill from `seed` by `steps`. take(place) returns true, once, for each place of the region, and marks it.
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

/// Makes cells with the edge with which about `wanted` of them fill the mesh, multiplied by `coarser`.
MuscleGrid make_muscle_grid(const TriangleMesh& mesh, double wanted, double coarser = 1);

/// Averages tensors, one per cell, over cells within about `reach` [m]. They are 0 outside the muscle.
void smooth(const MuscleGrid& grid, double reach, std::vector<Eigen::Matrix3d>& tensors);

}  // namespace frontalis
