#include "solver/stepping/added_stiffness_matrix.hpp"

#include "frontalis/physics/trilinear.hpp"

#include <Eigen/SparseCore>

namespace frontalis
{
namespace
{

using SparseMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor, std::int32_t>;
using Triplet = Eigen::Triplet<double, std::int32_t>;

SparseMatrix matrix_of(std::size_t rows, std::size_t columns, const std::vector<Triplet>& entries)
{
  SparseMatrix matrix(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(columns));
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

// Displacements of all nodes from those of the nodes that move by themselves.
SparseMatrix nodes_from_moving(const Discretisation& discretisation, const std::vector<double>& root)
{
  std::vector<Triplet> entries;
  for (std::int32_t n = 0; n < static_cast<std::int32_t>(root.size()); ++n)
    if (root[n] > 0)
      entries.emplace_back(n, n, 1);
  for (const auto& node : discretisation.followers)
    if (root[node.master] > 0)
      entries.emplace_back(node.node, node.master, node.ratio);
  return matrix_of(root.size(), root.size(), entries);
}

// Displacements of points from those of nodes.
SparseMatrix points_from_nodes(const Model& model, const Binding& binding)
{
  std::vector<Triplet> entries;
  for (std::size_t p = 0; p < binding.voxel.size(); ++p)
  {
    const auto& at = binding.coordinates[p];
    double weight[8];
    physics::trilinear_weights<double>(at[0], at[1], at[2], weight);
    for (std::size_t b = 0; b < 8; ++b)
      entries.emplace_back(static_cast<std::int32_t>(p), model.voxel_nodes[binding.voxel[p]][b], weight[b]);
  }
  return matrix_of(binding.voxel.size(), model.nodes.size(), entries);
}

}  // namespace

AddedStiffnessMatrix::AddedStiffnessMatrix(const Model& model, const Discretisation& discretisation,
                                           const std::vector<double>& root)
{
  if (discretisation.added.empty())
    return;
  const SparseMatrix nodes = nodes_from_moving(discretisation, root);
  SparseMatrix sum(nodes.rows(), nodes.cols());
  for (const auto& added : discretisation.added)
    for (const PointStiffness& of_points : added->matrices())
    {
      std::vector<Triplet> entries;
      for (const auto& entry : of_points.entries)
        entries.emplace_back(entry.row, entry.column, entry.value);
      const std::size_t count = of_points.binding->voxel.size();
      const SparseMatrix points = points_from_nodes(model, *of_points.binding) * nodes;
      const SparseMatrix forces = matrix_of(count, count, entries) * points;
      const SparseMatrix at_nodes = SparseMatrix(points.transpose()) * forces;
      sum += at_nodes;
    }
  sum.makeCompressed();
  for (std::int32_t n = 0; n < static_cast<std::int32_t>(root.size()); ++n)
    if (sum.outerIndexPtr()[n] < sum.outerIndexPtr()[n + 1])
    {
      row_.push_back(n);
      row_begin_.push_back(sum.outerIndexPtr()[n]);
    }
  row_begin_.push_back(static_cast<std::int32_t>(sum.nonZeros()));
  column_.assign(sum.innerIndexPtr(), sum.innerIndexPtr() + sum.nonZeros());
  stiffness_.assign(sum.valuePtr(), sum.valuePtr() + sum.nonZeros());
  masses_changed(root);
}

void AddedStiffnessMatrix::masses_changed(const std::vector<double>& root)
{
  value_.resize(stiffness_.size());
  for (std::size_t row = 0; row < row_.size(); ++row)
    for (auto i = row_begin_[row]; i < row_begin_[row + 1]; ++i)
      value_[i] = static_cast<float>(root[row_[row]] * static_cast<double>(stiffness_[i]) * root[column_[i]]);
}

}  // namespace frontalis
