#pragma once

#include "frontalis/model/model.hpp"
#include "surface_search.hpp"

#include <array>
#include <vector>

namespace frontalis
{

/// Bounding-box tree over a triangle mesh for exact closest points, with the pseudonormal of the face, edge or corner
/// found (Baerentzen & Aanaes 2005), which tells the side. Read-only after construction.
class SurfaceTree
{
public:
  using Point = SurfaceSearch::Point;
  using Closest = SurfaceSearch::Closest;

  /// Largest error of the plane that stands for the offset surface between two searches [m].
  static constexpr double plane_error = 8e-6;

  explicit SurfaceTree(const TriangleMesh& mesh);

  /// Closest point of the surface to p; looks no farther than `within` [m] (triangle -1 where nothing is that near).
  Closest closest(const Point& p, double within) const { return search().closest(p, within); }

  const std::vector<SurfaceSearch::Box>& boxes() const { return boxes_; }
  const std::vector<SurfaceSearch::Triangle>& triangles() const { return triangles_; }
  SurfaceSearch search() const
  {
    return { boxes_.data(), triangles_.data(), static_cast<std::int32_t>(boxes_.size()) };
  }

private:
  void allow_slip(const TriangleMesh& mesh);
  void build(std::int32_t first, std::int32_t last);

  std::vector<SurfaceSearch::Box> boxes_;
  std::vector<SurfaceSearch::Triangle> triangles_;
};

}  // namespace frontalis
