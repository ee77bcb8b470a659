#pragma once

#include "solver/stepping/array_list.hpp"
#include "solver/stepping/discretisation.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace frontalis
{

/// M^-1/2 K M^-1/2 of the sum K of Discretisation::added, between the nodes that move in the search for the highest
/// frequency, in compressed rows. It is the same along all axes.
class AddedStiffnessMatrix
{
public:
  /// `root`: as roots_for_search(); nodes with 0 do not move.
  AddedStiffnessMatrix(const Model& model, const Discretisation& discretisation, const std::vector<double>& root);

  /// Called with new roots after masses have changed.
  void masses_changed(const std::vector<double>& root);

  /// Adds `factor` times the products of rows [first, end) with the vectors `x`, one per axis, to `out`.
  template <class Real>
  void add_product(std::int32_t first, std::int32_t end, Real factor, const std::array<std::vector<Real>, 3>& x,
                   std::array<std::vector<Real>, 3>& out) const
  {
    const Real* const from[3] = { x[0].data(), x[1].data(), x[2].data() };
    for (auto row = std::lower_bound(row_.begin(), row_.end(), first) - row_.begin();
         row < static_cast<std::ptrdiff_t>(row_.size()) && row_[row] < end; ++row)
    {
      Real sum[3] = {};
      for (auto i = row_begin_[row]; i < row_begin_[row + 1]; ++i)
        for (std::size_t axis = 0; axis < 3; ++axis)
          sum[axis] += static_cast<Real>(value_[i]) * from[axis][column_[i]];
      for (std::size_t axis = 0; axis < 3; ++axis)
        out[axis][row_[row]] += factor * sum[axis];
    }
  }
  void list_arrays(const std::string& what, ArrayList& list) const
  {
    list.add(what, row_);
    list.add(what, row_begin_);
    list.add(what, column_);
    list.add(what, stiffness_);
    list.add(what, value_);
  }

private:
  std::vector<std::int32_t> row_, row_begin_;  // nodes with a stiffness; the first entry of each, and the number of all
  std::vector<std::int32_t> column_;
  std::vector<float> stiffness_, value_;  // per entry: of K [N/m], and of the matrix [1/s2]
};

}  // namespace frontalis
