#pragma once

#include "bake/fibres/fibre_coordinates.hpp"

#include <Eigen/SparseCore>

#include <utility>

namespace frontalis
{

/// A field given by its values at the corners of each cell. An angle in revolutions may jump by 1 between cells.
using CornerField = std::vector<std::array<double, 8>>;

/// Gradient at the middle of a cell [1/m].
Vector3d gradient(const MuscleGrid& grid, const std::array<double, 8>& corners);

/// Scalar fields f of trilinear elements on a muscle's grid. Their energy is the integral of grad(f) . D grad(f) with
/// one tensor D per cell.
class GridField
{
public:
  struct Modes
  {
    Eigen::VectorXd values;  ///< eigenvalues, ascending [1/m2]
    Eigen::MatrixXd fields;  ///< nodal values, one column per mode; their mean is 0
  };

  GridField(const MuscleGrid& grid, const std::vector<Eigen::Matrix3d>& tensors);
  /// Sets D = d d^T + `rest` I in each cell, where the unit vector d is the cell's entry of `directions`. The first
  /// term is integrated at one point to avoid locking.
  GridField(const MuscleGrid& grid, const std::vector<Vector3d>& directions, double rest);

  /// The non-constant eigenmodes with the lowest ratio of energy to mean square, found by subspace iteration. There is
  /// one mode per column of `start`; only the first ones are accurate.
  Modes slowest_modes(const Eigen::MatrixXd& start) const;
  /// The field of least energy with given values at nodes: pairs (node, value).
  Eigen::VectorXd between(const std::vector<std::pair<std::int32_t, double>>& fixed) const;
  /// The correction (nodal values) that minimises the energy of the sum of `field` and correction.
  Eigen::VectorXd balance(const CornerField& field) const;

private:
  using Stiffness = Eigen::Matrix<double, 8, 8>;

  void assemble();
  /// The stiffness matrix plus a small multiple of the mass matrix, which makes it regular.
  Eigen::SparseMatrix<double> shifted() const;

  const MuscleGrid& grid_;
  std::vector<Stiffness> cells_;
  Eigen::SparseMatrix<double> matrix_;
  Eigen::VectorXd mass_;
};

/// Fibre direction inferred from the muscle's surface around a cell: along striations or along a narrow muscle. The
/// sign is arbitrary.
struct SurfaceDirection
{
  Vector3d direction;
  double certainty = 0;  ///< 0 to 1
};

/// Finds directions from the covariance of the surface's normals within about `reach` [m] of each cell.
std::vector<SurfaceDirection> surface_directions(const MuscleGrid& grid, double reach);

/// Conductivity of each cell: 1 across its direction and 1 - certainty, but at least 0.02, along it.
std::vector<Eigen::Matrix3d> conductivities(const std::vector<SurfaceDirection>& directions);

/// Weighted mean of the surface's direction and of the gradient, smoothed over `reach` [m]. The weight of the surface's
/// direction is its certainty times the cosine of the angle between the two. This cosine is small where a muscle is cut
/// straight.
std::vector<SurfaceDirection> blend(const MuscleGrid& grid, double reach,
                                    const std::vector<SurfaceDirection>& directions,
                                    const std::vector<Vector3d>& gradients);

/// Maps a value of a field to the mean distance [m] of its isosurface from the isosurface of the field's smallest
/// value.
class DistanceTable
{
public:
  /// `periodic`: the field counts revolutions around a ring; only their fractional part is used.
  DistanceTable(const MuscleGrid& grid, const CornerField& field, bool periodic);
  double length() const { return distances_.back(); }
  double operator()(double value) const;

private:
  std::vector<double> values_, distances_;
};

/// Rescales the coordinate with the index `stretched`, so that at every value of the other coordinate it runs from 0 to
/// 1 between its smoothed limits on the muscle's surface. Lines on which the other coordinate is constant keep their
/// shape. `closed`: the other coordinate runs around a ring. Where the other coordinate is closer than `ends` to 0 or
/// 1, the limits at `ends` or 1 - `ends` are used.
void stretch(const MuscleGrid& grid, std::size_t stretched, bool closed, double ends, FibreCoordinates& coordinates);

}  // namespace frontalis
