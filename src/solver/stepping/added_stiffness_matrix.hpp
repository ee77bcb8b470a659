#pragma once

#include "solver/stepping/array_list.hpp"
#include "solver/stepping/discretisation.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace frontalis
{

/// The sum of Discretisation::added, divided by the square roots of masses, between the nodes that move in the search
/// for the highest frequency: M^-1/2 K M^-1/2 in compressed rows. It is the same along all axes.
class AddedStiffnessMatrix
{
public:
  /// `root`: as roots_for_search().
  AddedStiffnessMatrix(const Model& model, const Discretisation& discretisation, const std::vector<double>& root);

  /// Adds `factor` times the products of rows [first, end) with the vectors `x`, one per axis, to `out`.
  template <class Real>
  void add_product(std::int32_t first, std::int32_t end, Real factor, const std::array<std::vector<Real>, 3>& x,
                   std::array<std::vector<Real>, 3>& out) const
  {
    for (std::int32_t row = first; row < end && !value_.empty(); ++row)
    {
      Real sum[3] = {};
      for (auto i = row_begin_[row]; i < row_begin_[row + 1]; ++i)
        for (std::size_t axis = 0; axis < 3; ++axis)
          sum[axis] += static_cast<Real>(value_[i]) * x[axis][column_[i]];
      for (std::size_t axis = 0; axis < 3; ++axis)
        out[axis][row] += factor * sum[axis];
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
  std::vector<float> value_;  // [1/s2]
};

}  // namespace frontalis
