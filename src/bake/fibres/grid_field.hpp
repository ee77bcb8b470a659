#pragma once

#include "bake/fibres/muscle_grid.hpp"

#include <Eigen/SparseCore>

#include <array>
#include <utility>
#include <vector>

namespace frontalis
{

/// A field by its values at each cell's corners, which may jump by whole turns from cell to cell.
using CornerField = std::vector<std::array<double, 8>>;

/// At the middle of a cell [1/m].
Eigen::Vector3d gradient(const MuscleGrid& grid, const std::array<double, 8>& corners);

/// Scalar fields on a muscle's grid, by trilinear elements, that cost grad(f) . D grad(f) with a tensor D a cell.
class GridField
{
public:
  struct Modes
  {
    Eigen::VectorXd values;  ///< ascending [1/m2]
    Eigen::MatrixXd fields;  ///< nodal, a column a mode; orthogonal to constants
  };

  GridField(const MuscleGrid& grid, const std::vector<Eigen::Matrix3d>& tensors);
  /// D = d d^T + `rest` for unit directions d; the former with one-point quadrature, which does not lock.
  GridField(const MuscleGrid& grid, const std::vector<Eigen::Vector3d>& directions, double rest);

  /// Fields that cost least for their mean square, without the constant one: subspace iteration from `start`, as many
  /// as it has columns; the first ones are accurate.
  Modes slowest_modes(const Eigen::MatrixXd& start) const;
  /// The cheapest field with given values at some nodes.
  Eigen::VectorXd between(const std::vector<std::pair<std::int32_t, double>>& fixed) const;
  /// What makes a field the cheapest when it is added.
  Eigen::VectorXd balance(const CornerField& field) const;

private:
  using Stiffness = Eigen::Matrix<double, 8, 8>;

  void assemble();
  Eigen::SparseMatrix<double> shifted() const;

  const MuscleGrid& grid_;
  std::vector<Stiffness> cells_;
  Eigen::SparseMatrix<double> matrix_;
  Eigen::VectorXd mass_;
};

}  // namespace frontalis
