#pragma once

#include "bake/mesh/surface_mesh.hpp"

namespace frontalis
{

struct ClosestPoint
{
  Vector3d point{ 0, 0, 0 };
  double distance = 0;         ///< [m]
  std::int32_t triangle = -1;  ///< -1: no triangle lies within the bound
  /// The part of the triangle on which the point lies. 0: face; 1 to 3: edge from corner `feature` - 1; 4 to 6: corner
  /// `feature` - 4.
  std::int8_t feature = 0;
};

/// Bounding-volume hierarchy over a mesh's triangles for closest points, overlaps with boxes, and the generalised
/// winding number by the method of Barill et al., Fast winding numbers for soups and clouds, ACM Trans. Graph.
/// 37(4):43, 2018. Far groups of triangles contribute the Taylor series of the dipole potential about their area
/// centroid (up to the kernel's second derivative), near triangles their exact solid angles (van Oosterom & Strackee
/// 1983). CGAL's AABB tree has no winding numbers and takes 1.3 to 2.3 times as long to find closest points.
class TriangleTree
{
public:
  explicit TriangleTree(const TriangleMesh& mesh);

  const TriangleMesh& mesh() const { return *mesh_; }

  /// The closest point within `bound` [m] of p. `hint`, the index of a triangle that is probably near, saves time
  /// without changing the result.
  ClosestPoint closest(const Vector3d& p, double bound = 1e300, std::int32_t hint = -1) const;

  bool overlaps(const Box& box) const;
  /// Whether the segment p -> q passes through a triangle.
  bool crossed_by(const Vector3d& p, const Vector3d& q) const;
  /// Appends the triangles that overlap the box, in ascending order of index.
  void gather(const Box& box, std::vector<std::int32_t>& triangles) const;

  /// The winding number: 1 inside a closed surface with outward normals, 0 outside it, between 0 and 1 near a hole.
  double winding_number(const Vector3d& p) const;

private:
  friend class ClusterSearch;
  struct Node
  {
    Box box;
    std::int32_t begin = 0, end = 0;  ///< range of triangles in order_
    std::int32_t right = 0;           ///< index of the second child, 0 for a leaf; the first child is the next node
  };
  /// Taylor series of a node's winding number about its area centroid.
  struct Expansion
  {
    Vector3d centre{ 0, 0, 0 };
    double squared_reach = 0;
    Vector3d dipole{ 0, 0, 0 };
    std::array<double, 9> first{};    ///< first moments: sum of area normal i times offset j from the centre
    std::array<double, 18> second{};  ///< second moments, with offsets j and k: xx, yy, zz, xy, yz, zx
  };

  /// Walks from the root to the children of nodes for which enter(node index) is true, and calls leaf(index in order_)
  /// for each triangle that it reaches, until a call returns true. Returns whether a call did.
  template <class Enter, class Leaf>
  bool visit(const Enter& enter, const Leaf& leaf) const
  {
    std::int32_t stack[64];
    int top = 0;
    if (!nodes_.empty())
      stack[top++] = 0;
    while (top > 0)
    {
      const std::int32_t index = stack[--top];
      if (!enter(index))
        continue;
      const Node& node = nodes_[index];
      if (node.right != 0)
      {
        stack[top++] = node.right;
        stack[top++] = index + 1;
        continue;
      }
      for (std::int32_t i = node.begin; i < node.end; ++i)
        if (leaf(i))
          return true;
    }
    return false;
  }

  /// Four boxes that are compared with a point at once: boxes of the grandchildren of a node, or of a leaf's triangles.
  struct Four
  {
    std::array<Eigen::Array4d, 3> lower, upper;  ///< corners of the boxes; an unused box is infinitely far
    /// for each box the index of the next Four or, for a triangle, ~(index in order_)
    std::array<std::int32_t, 4> below{};
  };
  void add_four(std::int32_t node);  ///< appends the boxes below a node

  std::int32_t build(std::int32_t begin, std::int32_t end, const std::vector<Vector3d>& centroids);
  Expansion expand(const Node& node) const;
  static double far_field(const Expansion& node, const Vector3d& p);
  const TriangleMesh* mesh_;
  std::vector<std::int32_t> order_;               ///< triangle indices, contiguous for each node
  std::vector<std::array<Vector3d, 3>> corners_;  ///< corners of the triangles, in the order of order_
  std::vector<Node> nodes_;
  std::vector<Four> fours_;
  std::vector<Expansion> expansions_;
};

/// How the segment from p to q crosses a triangle: +1 inwards, -1 outwards, 0 not at all. A segment through the edge of
/// two triangles crosses exactly one of them, so that crossings add up to the change of the winding number.
int crossing(const TriangleMesh& mesh, std::int32_t triangle, const Vector3d& p, const Vector3d& q);

/// Solid angle of a triangle seen from p, divided by 4 pi; positive if p lies behind the triangle.
double winding_of_triangle(const Vector3d& p, const Vector3d& a, const Vector3d& b, const Vector3d& c);

}  // namespace frontalis
