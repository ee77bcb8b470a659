#pragma once

#include "frontalis/physics/number.hpp"
#include "solver/contact/touch_search.hpp"
#include "solver/stepping/array_list.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace frontalis
{

/// A uniform grid of triangles, sorted by the centres of the balls around them. Its cells are hashed into a table, so
/// that memory does not grow with the extent of the triangles.
class TriangleGrid
{
public:
  using Vector = physics::Vec3<double>;
  struct Triangle
  {
    Vector centre;
    double radius;  // of the ball [m]
  };

  void resize(std::size_t count);
  void list_arrays(ArrayList& list, Effect effect);
  /// Sorts triangles into cells that are as long as `reach` [m] and the largest radius together.
  void build(double reach, const std::vector<Triangle>& triangles);
  /// Edge of a cell [m].
  double edge() const { return edge_[0]; }
  /// Calls visit(index) for all triangles whose balls are within the reach of p; may visit a triangle twice.
  template <class Visit>
  void near(const Vector& p, const Visit& visit) const
  {
    const std::array<float, 3> at = single(p);
    const auto [i, j, k] = cell(p);
    for (std::int64_t z = k - 1; z <= k + 1; ++z)
      for (std::int64_t y = j - 1; y <= j + 1; ++y)
        for (std::int64_t x = i - 1; x <= i + 1; ++x)
        {
          const std::size_t bucket = hash(x, y, z);
          for (auto e = begin_[bucket]; e < begin_[bucket + 1]; ++e)
          {
            const Entry& entry = entries_[e];
            const float dx = entry.centre[0] - at[0], dy = entry.centre[1] - at[1], dz = entry.centre[2] - at[2];
            if (dx * dx + dy * dy + dz * dz <= entry.farthest * entry.farthest)
              visit(entry.index);
          }
        }
  }

private:
  struct Entry
  {
    std::array<float, 3> centre;
    float farthest;  // distance from the centre within which the triangle is visited [m]
    std::int32_t index;
  };

  static std::array<float, 3> single(const Vector& p) { return { { float(p.x), float(p.y), float(p.z) } }; }
  std::array<std::int64_t, 3> cell(const Vector& p) const
  {
    // Coordinates that are not finite count as cell 0.
    const auto index = [&](double x)
    { return std::abs(x) < 1e9 * edge_[0] ? static_cast<std::int64_t>(std::floor(x / edge_[0])) : std::int64_t(0); };
    return { { index(p.x), index(p.y), index(p.z) } };
  }
  std::size_t hash(std::int64_t x, std::int64_t y, std::int64_t z) const
  {
    return touch_search::cell_hash(x, y, z) & (begin_.size() - 2);
  }

  std::vector<double> edge_ = std::vector<double>(1, 1.0);  // edge of a cell [m]; the vector has one entry
  std::vector<std::int32_t> begin_;  // start of each bucket; the number of buckets is a power of 2
  std::vector<Entry> entries_;
};

}  // namespace frontalis
