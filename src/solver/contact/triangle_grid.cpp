#include "solver/contact/triangle_grid.hpp"

#include <algorithm>
#include <numeric>

namespace frontalis
{

void TriangleGrid::resize(std::size_t count)
{
  std::size_t buckets = 1;
  while (buckets < count)
    buckets *= 2;
  begin_.assign(buckets + 1, 0);
  entries_.assign(count, {});
  edge_[0] = 1;
}

void TriangleGrid::list_arrays(ArrayList& list, Effect effect)
{
  list.add_state(effect, "grid", edge_);
  list.add_state(effect, "grid", begin_);
  list.add_state(effect, "grid", entries_);
}

void TriangleGrid::build(double reach, const std::vector<Triangle>& triangles)
{
  double largest = 0;
  for (const Triangle& triangle : triangles)
    largest = std::max(largest, triangle.radius);
  edge_[0] = reach + largest;
  std::fill(begin_.begin(), begin_.end(), 0);
  std::vector<std::int32_t> bucket;
  bucket.reserve(triangles.size());
  for (const Triangle& triangle : triangles)
  {
    const auto [i, j, k] = cell(triangle.centre);
    bucket.push_back(static_cast<std::int32_t>(hash(i, j, k)));
    ++begin_[bucket.back() + 1];
  }
  std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
  std::vector<std::int32_t> next(begin_.begin(), begin_.end() - 1);
  for (std::size_t n = 0; n < triangles.size(); ++n)
  {
    const auto& [centre, radius] = triangles[n];
    entries_[next[bucket[n]]++] = { single(centre), static_cast<float>(reach + radius), static_cast<std::int32_t>(n) };
  }
}

}  // namespace frontalis
