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

/// A uniform grid of points. Its cells are hashed into a table, so that memory does not grow with the extent of the
/// points.
class TriangleGrid
{
public:
  using Vector = physics::Vec3<double>;

  void resize(std::size_t count);
  void list_arrays(ArrayList& list, Effect effect);
  /// Sorts points into cells with edges of the length `reach` [m].
  void build(double reach, const std::vector<Vector>& points);
  double reach() const { return edge_[0]; }
  /// Calls visit(index) for all points within the reach of p, and also for some farther points; may visit a point
  /// twice.
  template <class Visit>
  void near(const Vector& p, const Visit& visit) const
  {
    const auto [i, j, k] = cell(p);
    for (std::int64_t z = k - 1; z <= k + 1; ++z)
      for (std::int64_t y = j - 1; y <= j + 1; ++y)
        for (std::int64_t x = i - 1; x <= i + 1; ++x)
        {
          const std::size_t bucket = hash(x, y, z);
          for (auto e = begin_[bucket]; e < begin_[bucket + 1]; ++e)
            visit(entries_[e]);
        }
  }

private:
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
  std::vector<std::int32_t> entries_;
};

}  // namespace frontalis
