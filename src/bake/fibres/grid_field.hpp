#pragma once

#include "bake/fibres/muscle_grid.hpp"

#include <Eigen/SparseCore>

#include <array>
#include <utility>
#include <vector>

namespace frontalis
{

/// A field given by its values at the corners of each cell. It may jump by whole numbers from cell to cell.
using CornerField = std::vector<std::array<double, 8>>;

/// Gradient at the middle of a cell [1/m].
Vector3d gradient(const MuscleGrid& grid, const std::array<double, 8>& corners);

/// Scalar fields f on a muscle's grid, by trilinear elements, whose energy is the integral of grad(f) . D grad(f) with
/// one tensor D per cell.
class GridField
{
public:
  struct Modes
  {
    Eigen::VectorXd values;  ///< ascending [1/m2]
    Eigen::MatrixXd fields;  ///< nodal values, one column per mode; orthogonal to constants
  };

  GridField(const MuscleGrid& grid, const std::vector<Eigen::Matrix3d>& tensors);
  /// D = d d^T + `rest` I for unit directions d. One-point quadrature of the first part avoids locking.
  GridField(const MuscleGrid& grid, const std::vector<Vector3d>& directions, double rest);

  /// The non-constant eigenmodes with the lowest ratio of energy to mean square, by subspace iteration from `start`:
  /// one per column of it. Only the first ones are accurate.
  Modes slowest_modes(const Eigen::MatrixXd& start) const;
  /// The field of least energy with given values at some nodes.
  Eigen::VectorXd between(const std::vector<std::pair<std::int32_t, double>>& fixed) const;
  /// The field to be added to `field` so that the energy is least.
  Eigen::VectorXd balance(const CornerField& field) const;

private:
  using Stiffness = Eigen::Matrix<double, 8, 8>;

  void assemble();
  /// The matrix with a little of the mass matrix added, so that it is regular.
  Eigen::SparseMatrix<double> shifted() const;

  const MuscleGrid& grid_;
  std::vector<Stiffness> cells_;
  Eigen::SparseMatrix<double> matrix_;
  Eigen::VectorXd mass_;
};

}  // namespace frontalis
