#pragma once

#include "solver/stepping/array_list.hpp"
#include "solver/stepping/discretisation.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace frontalis
{

/// The sum of Discretisation::added between the nodes that move in the search for the highest frequency, in compressed
/// rows. It is the same along all axes.
class AddedStiffnessMatrix
{
public:
  /// `root`: as roots_for_search(); nodes with 0 do not move.
  AddedStiffnessMatrix(const Model& model, const Discretisation& discretisation, const std::vector<double>& root);

  /// Adds `factor` times the products of rows [first, end) of M^-1/2 K M^-1/2 with the vectors `x`, one per axis, to
  /// `out`. `root`: as roots_for_search().
  template <class Real>
  void add_product(std::int32_t first, std::int32_t end, const std::vector<Real>& root, Real factor,
                   const std::array<std::vector<Real>, 3>& x, std::array<std::vector<Real>, 3>& out) const
  {
    for (std::int32_t row = first; row < end && !value_.empty(); ++row)
    {
      Real sum[3] = {};
      for (auto i = row_begin_[row]; i < row_begin_[row + 1]; ++i)
      {
        const Real value = static_cast<Real>(value_[i]) * root[column_[i]];
        for (std::size_t axis = 0; axis < 3; ++axis)
          sum[axis] += value * x[axis][column_[i]];
      }
      for (std::size_t axis = 0; axis < 3; ++axis)
        out[axis][row] += factor * root[row] * sum[axis];
    }
  }
  void list_arrays(const std::string& what, ArrayList& list) const
  {
    list.add(what, row_begin_);
    list.add(what, column_);
    list.add(what, value_);
  }

private:
  std::vector<std::int32_t> row_begin_, column_;
  std::vector<float> value_;  // [N/m]
};

}  // namespace frontalis
