#pragma once

#include "discretisation.hpp"
#include "node_weights.hpp"

namespace frontalis
{

/// Bound of the highest frequency of a model, or of a part of it, and the node that sets it (physics/time_step.hpp).
struct StepBound
{
  double frequency_squared = 0;  ///< [1/s2]; NaN where the stiffness of a voxel is no number
  std::int32_t node = -1;

  /// Parts must be added in the order of their nodes.
  void add(const StepBound& part)
  {
    if (!(part.frequency_squared <= frequency_squared) && frequency_squared == frequency_squared)
      *this = part;
  }
};

/// Indices [first, last).
struct IndexRange
{
  std::int32_t first, last;
};

/// What a thread looks at: nodes, the voxels that can touch them (and more), and those among these that are its own.
struct ModelPart
{
  IndexRange nodes, touching, voxels;
};

/// Of some nodes, from the stiffness bound [N/m] of every voxel. squared: room for a number a node of the model, of
/// which these nodes' become their bounds of the frequency squared [1/s2], 0 where a node is held.
StepBound bound_of_nodes(const Discretisation& discretisation, const Model& model, const double* stiffness,
                         const NodeWeights& weights, const ModelPart& part, double* squared);

/// Of the whole model.
StepBound step_bound(const Discretisation& discretisation, const Model& model, const std::vector<double>& stiffness,
                     const NodeWeights& weights = {});

/// The whole model as one part.
ModelPart whole(const Model& model);

/// The stiffest of the voxels at a node; -1 for node -1.
std::int32_t stiffest_voxel_at(const Model& model, std::int32_t node, const double* stiffness);

/// 1 / mass [1/kg] of every node, 0 where it is held; empty where none is.
std::vector<float> mobility(const Discretisation& discretisation);

}  // namespace frontalis
