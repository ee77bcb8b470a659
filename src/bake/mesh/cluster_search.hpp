#pragma once

#include "bake/mesh/triangle_tree.hpp"

namespace frontalis
{

/// Closest points of a tree for points that come in clusters, such as the samples of a lattice: the triangles around
/// one point are kept, and as long as one of them must be the closest, no others are looked at. Results are those of
/// TriangleTree::closest().
class ClusterSearch
{
public:
  /// `extent` [m]: kept triangles serve at least all points within half of it of the point that they were found for.
  ClusterSearch(const TriangleTree& tree, double extent) : tree_(&tree), extent_(extent) {}

  ClosestPoint closest(const Vector3d& p, double bound = 1e300);

private:
  /// Triangles that are compared with a point at once: the balls around them. Coordinates count from centre_ [m].
  struct Group
  {
    static constexpr std::size_t size = 8;
    double least;                          ///< distance of the nearest of them from centre_ [m]
    std::array<float, size> x, y, z;       ///< middles; those of unused ones are not numbers
    std::array<float, size> radius;        ///< of the balls [m]
    std::array<std::int32_t, size> index;  ///< in TriangleTree::order_
  };
  void gather(const Vector3d& p, double reach);

  const TriangleTree* tree_;
  double extent_;
  Vector3d centre_{ 0, 0, 0 };
  double reach_ = -1;          ///< all triangles within this of centre_ are kept [m]; below 0: none yet
  std::vector<Group> groups_;  ///< by ascending distance
  std::int32_t latest_ = -1;   ///< index in TriangleTree::order_ of the triangle found last; -1: none
};

}  // namespace frontalis
