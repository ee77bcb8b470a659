#include "bake/fibres/grid_field.hpp"

#include "frontalis/error.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/SparseCholesky>

namespace frontalis
{
namespace
{

using Stiffness = Eigen::Matrix<double, 8, 8>;

struct Cholesky : Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>
{
  /// Throws Error naming the field if the matrix is singular.
  Cholesky(const Eigen::SparseMatrix<double>& matrix, const char* field) : SimplicialLDLT(matrix)
  {
    if (info() != Eigen::Success)
      throw Error(std::string("the field ") + field + " cannot be solved for");
  }
};

/// Entry [a][b] has the integrals over the unit cube of dN_i/dx_a dN_j/dx_b for the trilinear shape functions N_i, N_j.
std::array<std::array<Stiffness, 3>, 3> unit_stiffness()
{
  const double mass[2][2] = { { 1.0 / 3, 1.0 / 6 }, { 1.0 / 6, 1.0 / 3 } };
  const double stiff[2][2] = { { 1, -1 }, { -1, 1 } };
  const double mixed[2][2] = { { -0.5, -0.5 }, { 0.5, 0.5 } };  // derivative of the first shape function
  std::array<std::array<Stiffness, 3>, 3> result;
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t b = 0; b < 3; ++b)
      for (int i = 0; i < 8; ++i)
        for (int j = 0; j < 8; ++j)
        {
          double product = 1;
          for (std::size_t d = 0; d < 3; ++d)
          {
            const int p = i >> d & 1, q = j >> d & 1;
            product *= a == d && b == d ? stiff[p][q] : (a == d ? mixed[p][q] : (b == d ? mixed[q][p] : mass[p][q]));
          }
          result[a][b](i, j) = product;
        }
  return result;
}

}  // namespace

Vector3d gradient(const MuscleGrid& grid, const std::array<double, 8>& corners)
{
  Vector3d g = Vector3d::Zero();
  for (int b = 0; b < 8; ++b)
    for (int a = 0; a < 3; ++a)
      g[a] += ((b >> a & 1) != 0 ? 0.25 : -0.25) * corners[b] / grid.edge;
  return g;
}

GridField::GridField(const MuscleGrid& grid, const std::vector<Eigen::Matrix3d>& tensors) : grid_(grid)
{
  const auto unit = unit_stiffness();
  for (const Eigen::Matrix3d& tensor : tensors)
  {
    Stiffness stiffness = Stiffness::Zero();
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = 0; b < 3; ++b)
        stiffness += tensor(a, b) * grid.edge * unit[a][b];
    cells_.push_back(stiffness);
  }
  assemble();
}

GridField::GridField(const MuscleGrid& grid, const std::vector<Vector3d>& directions, double rest) : grid_(grid)
{
  const auto unit = unit_stiffness();
  const Stiffness isotropic = rest * grid.edge * (unit[0][0] + unit[1][1] + unit[2][2]);
  for (const Vector3d& direction : directions)
  {
    Eigen::Matrix<double, 8, 1> slope;
    for (int b = 0; b < 8; ++b)
      slope(b) =
          0.25 * ((b & 1 ? 1 : -1) * direction(0) + (b & 2 ? 1 : -1) * direction(1) + (b & 4 ? 1 : -1) * direction(2));
    cells_.emplace_back(isotropic + grid.edge * slope * slope.transpose());
  }
  assemble();
}

void GridField::assemble()
{
  const auto count = grid_.nodes.size();
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(64 * cells_.size());
  mass_ = Eigen::VectorXd::Zero(count);
  for (std::size_t c = 0; c < cells_.size(); ++c)
  {
    const auto& nodes = grid_.cell_nodes[c];
    for (std::size_t i = 0; i < 8; ++i)
    {
      mass_(nodes[i]) += grid_.edge * grid_.edge * grid_.edge / 8;
      for (std::size_t j = 0; j < 8; ++j)
        entries.emplace_back(nodes[i], nodes[j], cells_[c](i, j));
    }
  }
  matrix_.resize(count, count);
  matrix_.setFromTriplets(entries.begin(), entries.end());
}

Eigen::SparseMatrix<double> GridField::shifted() const
{
  // The shift is far below every eigenvalue except the eigenvalue 0 of the constant mode.
  const double extent = std::cbrt(mass_.sum());
  Eigen::SparseMatrix<double> matrix = matrix_;
  matrix.diagonal() += 1e-7 / (extent * extent) * mass_;
  return matrix;
}

GridField::Modes GridField::slowest_modes(const Eigen::MatrixXd& start) const
{
  const Cholesky solver(shifted(), "of its fibres");
  Modes modes;
  modes.fields = start;
  double before = 0;
  for (int iteration = 0; iteration < 40; ++iteration)
  {
    Eigen::MatrixXd& x = modes.fields;
    x.rowwise() -= (mass_.transpose() * x).eval() / mass_.sum();
    // Rayleigh-Ritz method: the best modes in the span of the columns.
    const Eigen::MatrixXd gram = x.transpose() * (mass_.asDiagonal() * x);
    const Eigen::MatrixXd energy = x.transpose() * (matrix_ * x);
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> ritz(energy, gram);
    modes.values = ritz.eigenvalues();
    x = (x * ritz.eigenvectors()).eval();
    if (std::abs(modes.values(0) - before) < 1e-5 * modes.values(0))
      break;
    before = modes.values(0);
    x = solver.solve(mass_.asDiagonal() * x).eval();
    // Columns of equal length keep the Gram matrix regular.
    for (Eigen::Index c = 0; c < x.cols(); ++c)
      x.col(c).normalize();
  }
  return modes;
}

Eigen::VectorXd GridField::between(const std::vector<std::pair<std::int32_t, double>>& fixed) const
{
  // Penalty method: stiff springs hold the given values.
  Eigen::SparseMatrix<double> matrix = shifted();
  Eigen::VectorXd load = Eigen::VectorXd::Zero(mass_.size());
  const double spring = 1e6 * grid_.edge;
  for (const auto& [node, value] : fixed)
  {
    matrix.coeffRef(node, node) += spring;
    load(node) = spring * value;
  }
  return Cholesky(matrix, "between its origin and insertion").solve(load);
}

Eigen::VectorXd GridField::balance(const CornerField& field) const
{
  Eigen::VectorXd load = Eigen::VectorXd::Zero(mass_.size());
  for (std::size_t c = 0; c < cells_.size(); ++c)
  {
    const Eigen::Matrix<double, 8, 1> force =
        cells_[c] * Eigen::Map<const Eigen::Matrix<double, 8, 1>>(field[c].data());
    for (std::size_t b = 0; b < 8; ++b)
      load(grid_.cell_nodes[c][b]) -= force(b);
  }
  return Cholesky(shifted(), "around its hole").solve(load);
}

}  // namespace frontalis
