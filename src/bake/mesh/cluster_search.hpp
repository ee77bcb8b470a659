#pragma once

#include "bake/mesh/triangle_tree.hpp"

namespace frontalis
{

/// Finds the closest points of a tree's triangles to points that come in clusters, such as the samples of a lattice. It
/// lists the triangles that can be the closest to a point of a cube and, where there are many points, those for each
/// eighth of the cube. Results are those of TriangleTree::closest(). Not thread-safe.
class ClusterSearch
{
public:
  /// A point outside of the present cube begins a cube of edge `extent` [m] around it.
  ClusterSearch(const TriangleTree& tree, double extent) : tree_(&tree), extent_(extent) {}

  ClosestPoint closest(const Vector3d& p, double bound = 1e300);

private:
  /// Four triangles near a cube. Points of the cube are at least `distance` + `away` . (point - centre) from each.
  struct Group
  {
    Eigen::Array4f distance;
    std::array<Eigen::Array4f, 3> away;
    std::array<std::int32_t, 4> index{};  ///< in TriangleTree::order_
  };
  struct Cube
  {
    Vector3d centre{ 0, 0, 0 };
    double half = 0;                 ///< half of an edge [m]
    std::size_t begin = 0, end = 0;  ///< range in groups_
  };
  /// A triangle that is added to a cube.
  struct Near
  {
    std::int32_t index;  ///< in TriangleTree::order_
    double distance;     ///< from the cube's centre [m]
    Vector3d away;       ///< unit vector from the triangle to the centre; 0 if both are too near for a direction
  };
  ClosestPoint begin(const Vector3d& p, double bound);
  void gather();
  void divide(std::size_t eighth);
  void add(const Vector3d& centre, std::int32_t index);
  void add_groups(Cube& cube);

  const TriangleTree* tree_;
  double extent_;
  ClosestPoint first_;       ///< the point closest to the centre of the present cube, which is the first point in it
  int asked_ = 0;            ///< number of later points in the present cube
  std::vector<Cube> cubes_;  ///< the present cube and its eighths; empty: there was no search yet
  std::array<std::size_t, 8> eighths_{};  ///< indices in cubes_; 0: not made yet
  double reach_ = 0;  ///< triangles farther than this from the first cube's centre may be missing [m]
  std::vector<Group> groups_;
  std::vector<Near> near_;    ///< triangles of the cube that is being made
  std::int32_t latest_ = -1;  ///< index in TriangleTree::order_ of the triangle found last; -1: none
};

}  // namespace frontalis
