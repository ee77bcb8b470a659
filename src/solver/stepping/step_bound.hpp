#pragma once

#include "solver/stepping/discretisation.hpp"

namespace frontalis
{

/// Bound of the highest frequency of a model or of a part of it, and the node that sets it (physics/time_step.hpp).
struct StepBound
{
  double frequency_squared = 0;  ///< [1/s2]; NaN if the stiffness of a voxel is NaN
  std::int32_t node = -1;

  /// Includes the bound of another part of the model. Parts must be added in the order of their nodes.
  void add(const StepBound& part)
  {
    if (!(part.frequency_squared <= frequency_squared) && frequency_squared == frequency_squared)
      *this = part;
  }
};

/// The indices [first, last).
struct IndexRange
{
  std::int32_t first, last;
};

/// Bound of some nodes, from the stiffness bound of every voxel [N/m]. `voxels`: at least the voxels at these nodes.
/// `mobility`: of every node. `sum`: receives the sum of the bounds at each of these nodes; it has an entry per node of
/// the model.
StepBound bound_of_nodes(const Discretisation& discretisation, const Model& model, const double* stiffness,
                         IndexRange voxels, IndexRange nodes, const std::vector<float>& mobility, double* sum);

StepBound step_bound(const Discretisation& discretisation, const Model& model, const std::vector<double>& stiffness,
                     const std::vector<float>& mobility);

/// Index of the stiffest of the voxels at a node; -1 if `node` is -1.
std::int32_t stiffest_voxel_at(const Model& model, std::int32_t node, const double* stiffness);

/// Inverse of each node's mass in the bound [1/kg], 0 for held nodes.
std::vector<float> mobility(const Discretisation& discretisation);

/// Changes the mobility of some nodes so that their bound is at most `found` [1/s2] now and grows in proportion to the
/// stiffness of their voxels (StepBackend::measure_growth). `sum`: as found by bound_of_nodes().
void limit_mobility(const Discretisation& discretisation, IndexRange nodes, const double* sum, double found, bool keeps,
                    std::vector<float>& mobility);

}  // namespace frontalis
