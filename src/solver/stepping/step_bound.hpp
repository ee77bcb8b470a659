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
/// `sum`: memory for one number per node of the model; only the entries of these nodes are used.
StepBound bound_of_nodes(const Discretisation& discretisation, const Model& model, const double* stiffness,
                         IndexRange voxels, IndexRange nodes, double* sum);

StepBound step_bound(const Discretisation& discretisation, const Model& model, const std::vector<double>& stiffness);

/// Index of the stiffest of the voxels at a node; -1 if `node` is -1.
std::int32_t stiffest_voxel_at(const Model& model, std::int32_t node, const double* stiffness);

/// Inverse of each node's mass in the bound [1/kg], 0 for held nodes; empty if it is 1 / node_mass at every node.
std::vector<float> mobility(const Discretisation& discretisation);

}  // namespace frontalis
