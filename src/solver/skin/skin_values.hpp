#pragma once

#include "solver/stepping/discretisation.hpp"
#include "frontalis/solver/solver_state.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace frontalis
{

/// Strain or stress of the voxels around the skin's, taken to its vertices: means at nodes weighted by tissue, then
/// trilinear within the voxel that a vertex is bound to.
class SkinValues
{
public:
  /// Both must outlive it.
  SkinValues(const Model& model, const Discretisation& discretisation);

  /// `u`: displacements of all nodes [m]; `activation`: as fibres feel it.
  void compute(SkinField field, const std::vector<std::array<double, 3>>& u, const std::vector<float>& activation,
               EffectSet running, std::vector<float>& out);
  void list_allocations(AllocationList& list) const;

private:
  const Model& model_;
  const Discretisation& discretisation_;
  std::vector<std::int32_t> nodes_;                  // of the voxels that vertices are bound to, ascending
  std::vector<std::int32_t> voxels_;                 // with one of these nodes, ascending
  std::vector<std::array<std::int32_t, 8>> corner_;  // of each voxel: rank of the node; -1: not of the skin
  std::vector<double> sum_, weight_;                 // one per node
};

}  // namespace frontalis
