#pragma once

#include "frontalis/model/model.hpp"
#include "solver/contact/surface_search.hpp"

#include <array>
#include <vector>

namespace frontalis
{

/// Bounding-box tree of a triangle mesh for exact closest points, with the pseudonormal of the nearest face, edge or
/// corner, which tells the side (Baerentzen & Aanaes 2005). Read-only after construction.
class SurfaceTree
{
public:
  using Point = SurfaceSearch::Point;
  using Closest = SurfaceSearch::Closest;

  explicit SurfaceTree(const TriangleMesh& mesh);

  /// Closest point of the surface to p, at most `within` [m] away; triangle -1 if there is none.
  Closest closest(const Point& p, double within) const { return search().closest(p, within); }

  void near(const Point& p, NearTriangles& out) const { search().near(p, out); }

  const std::vector<SurfaceSearch::Box>& boxes() const { return boxes_; }
  const std::vector<SurfaceSearch::Triangle>& triangles() const { return triangles_; }
  SurfaceSearch search() const
  {
    return { boxes_.data(), triangles_.data(), static_cast<std::int32_t>(boxes_.size()) };
  }

private:
  void build(std::int32_t first, std::int32_t last);

  std::vector<SurfaceSearch::Box> boxes_;
  std::vector<SurfaceSearch::Triangle> triangles_;
};

}  // namespace frontalis
