#pragma once

#include "bake/mesh/surface_mesh.hpp"

#include <cstdint>
#include <vector>

namespace frontalis
{

/// Closest point of a surface.
struct ClosestPoint
{
  Vector3 point{ 0, 0, 0 };
  double distance = 0;
  std::int32_t triangle = -1;  ///< -1: none within the bound
  /// 0: the face; 1..3: the edge from corner feature - 1 to the next; 4..6: the corner feature - 4
  std::int8_t feature = 0;
};

/// Bounding-volume hierarchy over a mesh's triangles: closest points, overlap with boxes, and the generalised winding
/// number, evaluated hierarchically as in Barill et al., Fast winding numbers for soups and clouds, ACM Trans. Graph.
/// 37(4):43, 2018: far groups of triangles by the Taylor series of the dipole potential about their area centroid (to
/// the second derivative of the kernel), near triangles by their exact solid angles (van Oosterom & Strackee 1983).
class TriangleTree
{
public:
  explicit TriangleTree(const TriangleMesh& mesh);

  const TriangleMesh& mesh() const { return *mesh_; }

  /// The closest point within `bound` of p [m]. `hint`: a triangle that may be near, asked first; the answer is the
  /// same.
  ClosestPoint closest(const Vector3& p, double bound = 1e300, std::int32_t hint = -1) const;

  bool overlaps(const Box& box) const;
  /// Whether the segment p -> q passes through a triangle.
  bool crossed_by(const Vector3& p, const Vector3& q) const;
  /// Appends the triangles that overlap the box, in ascending order.
  void gather(const Box& box, std::vector<std::int32_t>& triangles) const;

  /// 1 inside a closed outward-oriented surface, 0 outside; between them near the holes of an open one.
  double winding_number(const Vector3& p) const;

private:
  struct Node
  {
    Box box;
    std::int32_t begin = 0, end = 0;  ///< triangles in order_
    std::int32_t right = 0;           ///< second child; the first is the next node; 0: leaf
  };
  /// Taylor series of a node's winding number about its area centroid.
  struct Expansion
  {
    Vector3 centre{ 0, 0, 0 };
    double squared_reach = 0;
    Vector3 dipole{ 0, 0, 0 };
    std::array<double, 9> first{};    ///< sum of area normal i times offset j
    std::array<double, 18> second{};  ///< sum of area normal i times offsets jk: xx, yy, zz, xy, yz, zx
  };

  /// Visits nodes from the root down: below those where `enter(node index)` is true, and `leaf(place in order_)` for
  /// each triangle there, until one answers true. Returns whether one did.
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
      if (!enter(static_cast<std::size_t>(index)))
        continue;
      const Node& node = nodes_[static_cast<std::size_t>(index)];
      if (node.right != 0)
      {
        stack[top++] = node.right;
        stack[top++] = index + 1;
        continue;
      }
      for (std::int32_t i = node.begin; i < node.end; ++i)
        if (leaf(static_cast<std::size_t>(i)))
          return true;
    }
    return false;
  }

  std::int32_t build(std::int32_t begin, std::int32_t end, const std::vector<Vector3>& centroids);
  Expansion expand(const Node& node) const;
  static double far_field(const Expansion& node, const Vector3& p);
  static bool overlaps_triangle(const std::array<Vector3, 3>& corners, const Box& box);
  const Vector3& corner(std::int32_t triangle, std::size_t c) const
  {
    return mesh_->vertices[static_cast<std::size_t>(mesh_->triangles[static_cast<std::size_t>(triangle)][c])];
  }

  const TriangleMesh* mesh_;
  std::vector<std::int32_t> order_;
  std::vector<std::array<Vector3, 3>> corners_;  ///< of the triangles, in the order of order_
  std::vector<Node> nodes_;
  std::vector<Expansion> expansions_;
};

/// Change of the winding number along the segment p -> q at a triangle: +1 inwards, -1 outwards, 0 no crossing. A
/// segment that meets an edge of two triangles crosses exactly one of them.
int crossing(const TriangleMesh& mesh, std::int32_t triangle, const Vector3& p, const Vector3& q);

/// Solid angle of a triangle seen from p over 4 pi, positive where p sees its back.
double winding_of_triangle(const Vector3& p, const Vector3& a, const Vector3& b, const Vector3& c);

}  // namespace frontalis
