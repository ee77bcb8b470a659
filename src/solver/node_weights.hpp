#pragma once

#include "discretisation.hpp"

#include <vector>

namespace frontalis
{

struct ModelPart;
class ThreadTeam;

/// Weights of nodes by which the highest frequency is bounded (physics/time_step.hpp); empty: all are 1. Any are right;
/// those found for a deformation are good as long as the same voxels are stiff.
struct NodeWeights
{
  std::vector<float> of_node;  ///< above 0, up to 1
  std::vector<float> share;    ///< physics::weighted_share() of each voxel
  double gain = 1;             ///< bound without them over that with them, where they were found
};

/// Shares of the voxels [first, last) from the weights of nodes.
void share_voxels(const Discretisation& discretisation, const Model& model, std::int32_t first, std::int32_t last,
                  NodeWeights& weights);

/// Finds weights that lower the bound for voxels of this stiffness [N/m], and returns the bound with them [1/s2]: empty
/// ones where there are none, or next to none. Three rounds, in each of which a node's weight falls with its own bound
/// over the largest. A part a thread; the result does not depend on their number.
double find_weights(const Discretisation& discretisation, const Model& model, const std::vector<double>& stiffness,
                    const std::vector<ModelPart>& parts, ThreadTeam& team, NodeWeights& weights);

}  // namespace frontalis
