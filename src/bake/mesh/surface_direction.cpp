#include "bake/mesh/surface_direction.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>

namespace frontalis
{
namespace
{

Eigen::Matrix3d matrix_of(const SymmetricTensor& t)
{
  Eigen::Matrix3d matrix;
  matrix << t[0], t[3], t[5], t[3], t[1], t[4], t[5], t[4], t[2];
  return matrix;
}

using Solver = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>;

/// Sums of area n n^T over the normals n within `reach` of each cell, apart for those nearest to each axis of an
/// icosahedron.
std::array<std::vector<SymmetricTensor>, 6> normal_covariances(const MuscleGrid& grid, double reach)
{
  constexpr double golden = 1.618033988749895;
  constexpr std::array<Vector3, 6> axes{
    { { 0, 1, golden }, { 0, -1, golden }, { 1, golden, 0 }, { -1, golden, 0 }, { golden, 0, 1 }, { golden, 0, -1 } }
  };
  std::array<std::vector<SymmetricTensor>, 6> sums;
  for (auto& sum : sums)
    sum.assign(grid.cells.size(), SymmetricTensor{});
  for (const MuscleGrid::Sample& sample : grid.samples)
  {
    if (sample.cell < 0)
      continue;
    std::size_t nearest = 0;
    for (std::size_t a = 1; a < axes.size(); ++a)
      if (std::abs(dot(sample.normal, axes[a])) > std::abs(dot(sample.normal, axes[nearest])))
        nearest = a;
    const SymmetricTensor product = square(sample.normal);
    for (std::size_t k = 0; k < 6; ++k)
      sums[nearest][static_cast<std::size_t>(sample.cell)][k] += sample.area * product[k];
  }
  for (auto& sum : sums)
    spread(grid, reach, sum);
  return sums;
}

}  // namespace

std::vector<ShownDirection> shown_directions(const MuscleGrid& grid, double reach)
{
  const auto sums = normal_covariances(grid, reach);
  std::vector<ShownDirection> shown;
  for (std::size_t c = 0; c < grid.cells.size(); ++c)
  {
    Eigen::Matrix3d all = Eigen::Matrix3d::Zero();
    for (const auto& sum : sums)
      all += matrix_of(sum[c]);
    // faces that meet at an edge, as those of a slab and its ends, say nothing: only normals like most count
    const Eigen::Vector3d axis = Solver(all).eigenvectors().col(2);
    Eigen::Matrix3d alike = Eigen::Matrix3d::Zero();
    for (const auto& sum : sums)
    {
      const Eigen::Matrix3d part = matrix_of(sum[c]);
      const double squared_cosine = part.trace() > 0 ? axis.dot(part * axis) / part.trace() : 0;
      alike += std::max(0.0, squared_cosine - 0.25) / 0.75 * part;
    }
    if (!(alike.trace() > 0))
    {
      shown.push_back({ Eigen::Vector3d::UnitX(), 0 });
      continue;
    }
    const Solver solver(alike / alike.trace());
    // a smooth sheet says nothing about directions in its plane
    constexpr double faint = 0.02;
    const double ratio =
        (std::max(0.0, solver.eigenvalues()(0)) + faint) / (std::max(0.0, solver.eigenvalues()(1)) + faint);
    shown.push_back({ solver.eigenvectors().col(0), 1 - ratio * ratio });
  }
  return shown;
}

std::vector<Eigen::Matrix3d> slow_along(const std::vector<ShownDirection>& shown)
{
  std::vector<Eigen::Matrix3d> tensors;
  tensors.reserve(shown.size());
  for (const ShownDirection& s : shown)
    tensors.emplace_back(Eigen::Matrix3d::Identity() - std::min(0.98, s.sure) * s.direction * s.direction.transpose());
  return tensors;
}

std::vector<ShownDirection> blend(const MuscleGrid& grid, double reach, const std::vector<ShownDirection>& shown,
                                  const std::vector<Eigen::Vector3d>& gradients)
{
  std::vector<SymmetricTensor> tensors;
  tensors.reserve(shown.size());
  for (std::size_t c = 0; c < shown.size(); ++c)
  {
    const Eigen::Vector3d g = gradients[c].stableNormalized();
    const double agree = shown[c].direction.dot(g);
    const double weight = shown[c].sure * std::abs(agree);
    const Eigen::Vector3d d = ((1 - weight) * g + std::copysign(weight, agree) * shown[c].direction).stableNormalized();
    tensors.push_back(square({ d(0), d(1), d(2) }));
  }
  spread(grid, reach, tensors);
  std::vector<ShownDirection> blended;
  blended.reserve(tensors.size());
  for (const SymmetricTensor& tensor : tensors)
    blended.push_back({ Solver(matrix_of(tensor)).eigenvectors().col(2), 0.95 });
  return blended;
}

}  // namespace frontalis
