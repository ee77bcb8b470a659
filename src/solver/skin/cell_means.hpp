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
  /// Sets the area of each vertex, in any unit. Call it before areas() and find_means().
  void set_areas(const Field& area);
  /// Area that belongs to each corner of the cells.
  const Field& areas() const { return area_; }

  const std::array<std::int32_t, 8>& corners(std::size_t vertex) const { return corner_[cell_[vertex]]; }
  const std::array<float, 8>& weights(std::size_t vertex) const { return weight_[vertex]; }
  /// Calls visit(first vertex, end, corners) for each cell.
  template <class Visit>
  void each_cell(const Visit& visit) const
  {
    for (std::size_t cell = 0; cell < corner_.size(); ++cell)
      visit(first_[cell], first_[cell + 1], corner_[cell]);
  }

  // A Value is a number or a tensor.
  /// Means at the corners of cells, from values times area at the vertices.
  template <class Value>
  void find_means(const std::vector<Value>& values, std::vector<Value>& means) const
  {
    means.assign(area_.size(), {});
    add(values, means);
    for (std::size_t c = 0; c < means.size(); ++c)
      means[c] *= 1 / std::max(area_[c], 1e-20F);
  }
  template <class Value>
  Value at(const std::vector<Value>& means, std::size_t vertex) const
  {
    const std::array<std::int32_t, 8>& corner = corners(vertex);
    Value mean = weight_[vertex][0] * means[corner[0]];
    for (std::size_t c = 1; c < 8; ++c)
      mean += weight_[vertex][c] * means[corner[c]];
    return mean;
  }

private:
  template <class Value>
  void add(const std::vector<Value>& values, std::vector<Value>& sums) const
  {
    each_cell(
        [&](std::size_t first, std::size_t last, const std::array<std::int32_t, 8>& corners_of_cell)
        {
          std::array<Value, 8> of_cell{};
          for (std::size_t v = first; v < last; ++v)
            for (std::size_t c = 0; c < 8; ++c)
              of_cell[c] += weight_[v][c] * values[v];
          for (std::size_t c = 0; c < 8; ++c)
            sums[corners_of_cell[c]] += of_cell[c];
        });
  }

  std::vector<std::int32_t> order_;
  std::vector<std::int32_t> cell_;                   // of each vertex
  std::vector<std::size_t> first_;                   // first vertex of each cell, and the number of all vertices
  std::vector<std::array<std::int32_t, 8>> corner_;  // of each cell
  std::vector<std::array<float, 8>> weight_;         // of each vertex
  Field area_;
};

}  // namespace frontalis
