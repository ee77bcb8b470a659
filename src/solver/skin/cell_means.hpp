#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace frontalis
{

/// Means of values at the vertices of a surface over the cells of a lattice in space. Each vertex contributes to the
/// eight corners of its cell with trilinear weights, so that means change smoothly along the surface.
class CellMeans
{
public:
  using Field = std::vector<float>;

  /// `edge`: length of a cell's edges [m].
  CellMeans(const std::vector<std::array<double, 3>>& points, double edge);

  /// Indices of the vertices sorted by cell, so that neighbours are close to each other in memory. All functions below
  /// number the vertices in this order.
  const std::vector<std::int32_t>& order() const { return order_; }
  /// Sets the area of each vertex [m2]. Call it before the following functions.
  void set_areas(const Field& area);
  /// Area that belongs to each corner of the cells [m2].
  const Field& areas() const { return area_; }

  // A Value is a number or a tensor.
  template <class Value>
  void add(std::vector<Value>& sums, std::size_t vertex, const Value& value) const
  {
    for (std::size_t c = 0; c < 8; ++c)
      sums[corner_[vertex][c]] += weight_[vertex][c] * value;
  }
  /// Converts sums of values times area to means.
  template <class Value>
  void divide_by_area(std::vector<Value>& sums) const
  {
    for (std::size_t c = 0; c < sums.size(); ++c)
      sums[c] *= 1 / std::max(area_[c], 1e-20F);
  }
  template <class Value>
  Value at(const std::vector<Value>& means, std::size_t vertex) const
  {
    Value mean = weight_[vertex][0] * means[corner_[vertex][0]];
    for (std::size_t c = 1; c < 8; ++c)
      mean += weight_[vertex][c] * means[corner_[vertex][c]];
    return mean;
  }

private:
  std::vector<std::int32_t> order_;
  std::vector<std::array<std::int32_t, 8>> corner_;
  std::vector<std::array<float, 8>> weight_;
  Field area_;
};

}  // namespace frontalis
