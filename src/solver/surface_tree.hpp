#pragma once

#include "frontalis/model/model.hpp"
#include "frontalis/physics/closest_point.hpp"

#include <array>
#include <vector>

namespace frontalis
{

/// Bounding-box tree over a triangle mesh for exact closest points, with the pseudonormal of the face, edge or corner
/// found (Baerentzen & Aanaes 2005), which tells the side. Read-only after construction.
class SurfaceTree
{
public:
  using Point = physics::Vec3<double>;

  struct Closest
  {
    Point point{};
    Point normal{};  ///< unit pseudonormal there
    double squared_distance = 0;
    std::int32_t triangle = -1;
  };

  explicit SurfaceTree(const TriangleMesh& mesh);

  /// Closest point of the surface to p; looks no farther than `within` [m] (triangle -1 where nothing is that near).
  Closest closest(const Point& p, double within) const;

private:
  struct Box
  {
    float lower[3];
    float upper[3];
    std::int32_t first = 0;  ///< inner: right child (the left one follows); leaf: first triangle
    std::int32_t count = 0;  ///< triangles of a leaf; 0: inner
  };
  struct Triangle
  {
    Point corner[3];
    std::int32_t index;
  };

  void build(std::int32_t first, std::int32_t last);
  Point pseudonormal(const Triangle& triangle, const Point& at) const;

  std::vector<Box> boxes_;
  std::vector<Triangle> triangles_;
  std::vector<std::array<std::int32_t, 3>> corners_;  // mesh triangles
  std::vector<Point> vertex_normals_;                 // angle-weighted
  std::vector<std::array<Point, 3>> edge_normals_;    // of edges 01, 12, 20
  std::vector<Point> face_normals_;
};

}  // namespace frontalis
