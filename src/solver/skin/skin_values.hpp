#pragma once

#include "solver/stepping/discretisation.hpp"
#include "frontalis/solver/solver_state.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace frontalis
{

/// Strain or stress at the skin's vertices. Values at nodes are means over the surrounding voxels, weighted by tissue;
/// those at vertices are interpolated within the voxel to which a vertex is bound.
class SkinValues
{
public:
  /// Both arguments must outlive this object.
  SkinValues(const Model& model, const Discretisation& discretisation);

  /// `u`: displacements of all nodes [m]; `activation`: that of the fibres.
  void compute(SkinField field, const std::vector<std::array<double, 3>>& u, const std::vector<float>& activation,
               EffectSet running, std::vector<float>& out);
  void list_arrays(ArrayList& list) const;

private:
  const Model& model_;
  const Discretisation& discretisation_;
  std::vector<std::int32_t> nodes_;                  // nodes of the voxels to which vertices are bound, ascending
  std::vector<std::int32_t> voxels_;                 // voxels with one of these nodes, ascending
  std::vector<std::array<std::int32_t, 8>> corner_;  // index of each voxel's corners into nodes_; -1: not in nodes_
  std::vector<double> sum_, weight_;                 // one per node
};

}  // namespace frontalis
