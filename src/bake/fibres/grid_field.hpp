#pragma once

#include "bake/fibres/fibre_coordinates.hpp"

#include <Eigen/SparseCore>

#include <utility>

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

/// Direction of the fibres that a muscle's surface shows around a cell, along striations or along a narrow muscle. Its
/// sign means nothing.
struct SurfaceDirection
{
  Vector3d direction;
  double certainty = 0;  ///< 0 to 1
};

/// From the covariance of the surface's normals within about `reach` [m] of each cell.
std::vector<SurfaceDirection> surface_directions(const MuscleGrid& grid, double reach);

/// Conductivity of each cell: 1 across its direction, and the less along it the more certain the direction is.
std::vector<Eigen::Matrix3d> conductivities(const std::vector<SurfaceDirection>& directions);

/// The surface's direction where it is certain, the gradient elsewhere; the gradient too where both are at a large
/// angle, as they are at ends that are cut straight. Smoothed over `reach` [m].
std::vector<SurfaceDirection> blend(const MuscleGrid& grid, double reach,
                                    const std::vector<SurfaceDirection>& directions,
                                    const std::vector<Vector3d>& gradients);

/// Maps a value of a field to the mean distance [m] of the places that have it from those with the field's least value.
class DistanceTable
{
public:
  /// `periodic`: the field counts revolutions around a ring, of which the fraction is used.
  DistanceTable(const MuscleGrid& grid, const CornerField& field, bool periodic);
  double length() const { return distances_.back(); }
  double operator()(double value) const;

private:
  std::vector<double> values_, distances_;
};

/// Stretches one of the two coordinates, that of index `stretched`, so that it runs from 0 to 1 at every value of the
/// other. 0 and 1 are its smoothed limits on the muscle's surface. Lines along which the other coordinate is constant
/// keep their shape. `closed`: the other coordinate runs around a ring. If the other coordinate is closer than `ends`
/// to 0 or 1, the limits at that distance are used.
void stretch(const MuscleGrid& grid, std::size_t stretched, bool closed, double ends, FibreCoordinates& coordinates);

}  // namespace frontalis
