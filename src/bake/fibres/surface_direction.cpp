#include "bake/fibres/grid_field.hpp"

#include <Eigen/Eigenvalues>

namespace frontalis
{
namespace
{

using Solver = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>;

/// Sums of area times n n^T over the unit normals n within `reach` [m] of each cell. The normals are divided among the
/// six axes of an icosahedron by the nearest axis, with one sum per axis.
std::array<std::vector<Eigen::Matrix3d>, 6> normal_covariances(const MuscleGrid& grid, double reach)
{
  constexpr double golden = 1.618033988749895;
  const std::array<Vector3d, 6> axes{
    { { 0, 1, golden }, { 0, -1, golden }, { 1, golden, 0 }, { -1, golden, 0 }, { golden, 0, 1 }, { golden, 0, -1 } }
  };
  std::array<std::vector<Eigen::Matrix3d>, 6> sums;
  sums.fill(std::vector<Eigen::Matrix3d>(grid.cells.size(), Eigen::Matrix3d::Zero()));
  for (const MuscleGrid::Sample& sample : grid.samples)
  {
    if (sample.cell < 0)
      continue;
    std::size_t nearest = 0;
    for (std::size_t a = 1; a < axes.size(); ++a)
      if (std::abs(sample.normal.dot(axes[a])) > std::abs(sample.normal.dot(axes[nearest])))
        nearest = a;
    sums[nearest][sample.cell] += sample.area * (sample.normal * sample.normal.transpose());
  }
  for (auto& sum : sums)
    smooth(grid, reach, sum);
  return sums;
}

}  // namespace

std::vector<SurfaceDirection> surface_directions(const MuscleGrid& grid, double reach)
{
  const auto sums = normal_covariances(grid, reach);
  std::vector<SurfaceDirection> directions;
  for (std::size_t c = 0; c < grid.cells.size(); ++c)
  {
    Eigen::Matrix3d all = Eigen::Matrix3d::Zero();
    for (const auto& sum : sums)
      all += sum[c];
    // Only normals within 60 degrees of the principal one count, because edges between faces, for instance between a
    // slab and its ends, do not indicate fibres.
    const Vector3d axis = Solver(all).eigenvectors().col(2);
    Eigen::Matrix3d alike = Eigen::Matrix3d::Zero();
    for (const auto& sum : sums)
    {
      const Eigen::Matrix3d& part = sum[c];
      const double squared_cosine = part.trace() > 0 ? axis.dot(part * axis) / part.trace() : 0;
      alike += std::max(0.0, squared_cosine - 0.25) / 0.75 * part;
    }
    if (!(alike.trace() > 0))
    {
      directions.push_back({ Vector3d::UnitX(), 0 });
      continue;
    }
    const Solver solver(alike / alike.trace());
    // This value is added to the variances, so that a smooth sheet, with two variances near 0, has no direction in its
    // plane.
    constexpr double least_variance = 0.02;
    const Vector3d variance = solver.eigenvalues().cwiseMax(0.0).array() + least_variance;
    const double ratio = variance[0] / variance[1];
    directions.push_back({ solver.eigenvectors().col(0), 1 - ratio * ratio });
  }
  return directions;
}

std::vector<Eigen::Matrix3d> conductivities(const std::vector<SurfaceDirection>& directions)
{
  std::vector<Eigen::Matrix3d> tensors;
  tensors.reserve(directions.size());
  for (const auto& [direction, certainty] : directions)
    tensors.emplace_back(Eigen::Matrix3d::Identity() - std::min(0.98, certainty) * direction * direction.transpose());
  return tensors;
}

std::vector<SurfaceDirection> blend(const MuscleGrid& grid, double reach,
                                    const std::vector<SurfaceDirection>& directions,
                                    const std::vector<Vector3d>& gradients)
{
  // The average is that of d d^T instead of d, because the sign of a direction is arbitrary.
  std::vector<Eigen::Matrix3d> tensors;
  tensors.reserve(directions.size());
  for (std::size_t c = 0; c < directions.size(); ++c)
  {
    const auto& [direction, certainty] = directions[c];
    const Vector3d g = gradients[c].stableNormalized();
    const double agreement = direction.dot(g);
    const double weight = certainty * std::abs(agreement);
    const Vector3d d = ((1 - weight) * g + std::copysign(weight, agreement) * direction).stableNormalized();
    tensors.emplace_back(d * d.transpose());
  }
  smooth(grid, reach, tensors);
  std::vector<SurfaceDirection> blended;
  blended.reserve(tensors.size());
  for (const Eigen::Matrix3d& tensor : tensors)
    blended.push_back({ Solver(tensor).eigenvectors().col(2), 0.95 });
  return blended;
}

}  // namespace frontalis
