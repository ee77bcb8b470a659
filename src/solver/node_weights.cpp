#include "node_weights.hpp"

#include "frontalis/physics/time_step.hpp"
#include "step_bound.hpp"
#include "thread_team.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

constexpr int rounds = 3;
constexpr double worth_it = 0.98;  // of the bound without weights
// what stiffens before the next search where weights are small is not overrated by more than its inverse
constexpr double least_weight = 0.1;

}  // namespace

void share_voxels(const Discretisation& discretisation, const Model& model, std::int32_t first, std::int32_t last,
                  NodeWeights& weights)
{
  for (auto e = first; e < last; ++e)
  {
    double weight[8];
    for (int b = 0; b < 8; ++b)
      weight[b] = double(weights.of_node[model.voxel_nodes[e][b]]);
    weights.share[e] = static_cast<float>(physics::weighted_share(weight, discretisation.hourglass_share));
  }
}

double find_weights(const Discretisation& discretisation, const Model& model, const std::vector<double>& stiffness,
                    const std::vector<ModelPart>& parts, ThreadTeam& team, NodeWeights& weights)
{
  weights.of_node.assign(model.nodes.size(), 1);
  weights.share.assign(model.voxels.size(), 1);
  std::vector<double> squared(model.nodes.size());
  std::vector<StepBound> bounds(parts.size());
  double first = 0, last = 0;
  team.run(
      [&](int t)
      {
        const ModelPart& part = parts[t];
        for (int round = 0;; ++round)
        {
          bounds[t] = bound_of_nodes(discretisation, model, stiffness.data(), weights, part, squared.data());
          team.barrier();
          StepBound bound;
          for (const StepBound& of_part : bounds)
            bound.add(of_part);
          if (t == 0)
            (round == 0 ? first : last) = bound.frequency_squared;
          if (round == rounds || !(bound.frequency_squared > 0))
            return;
          for (auto n = part.nodes.first; n < part.nodes.last; ++n)
          {
            // to the power of 3/4: undamped, weights can swing
            const double ratio = squared[n] / bound.frequency_squared;
            const double lower = double(weights.of_node[n]) * std::sqrt(ratio * std::sqrt(ratio));
            weights.of_node[n] = static_cast<float>(std::max(lower, least_weight));
          }
          team.barrier();
          share_voxels(discretisation, model, part.voxels.first, part.voxels.last, weights);
          team.barrier();
        }
      });
  weights.gain = first / last;
  if (last > 0 && last < worth_it * first)
    return last;
  weights = {};
  return first;
}

}  // namespace frontalis
