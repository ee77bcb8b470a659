#pragma once

#include "bake/mesh/surface_mesh.hpp"

namespace frontalis
{

/// Cubic cells that fill a muscle's mesh: the cells through which its surface passes and the cells that these enclose.
/// Strands closer to each other than a cell merge, and voids are filled.
struct MuscleGrid
{
  /// A point of the surface that represents the area around it.
  struct Sample
  {
    Vector3d point;
    Vector3d normal;
    double area = 0;         ///< [m2]
    std::int32_t cell = -1;  ///< index of the sample's cell; -1: the cell was removed from the grid
  };

  Vector3d lower{ 0, 0, 0 };  ///< lower corner of the grid [m]
  double edge = 0;            ///< edge of a cell [m]
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

/// Flood fill from `seed` by `steps`. take(place) marks a place; it returns true, only once, if the place is in the
/// region.
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

/// Fills the mesh with cells. Their edge is `coarser` times the edge at which about `wanted` cells fill the mesh.
MuscleGrid make_muscle_grid(const TriangleMesh& mesh, double wanted, double coarser = 1);

/// Averages tensors, one per cell, over cells within about `reach` [m]. Tensors outside the muscle count as 0.
void smooth(const MuscleGrid& grid, double reach, std::vector<Eigen::Matrix3d>& tensors);

}  // namespace frontalis
