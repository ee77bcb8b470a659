#include "solver/stepping/step_bound.hpp"

#include <algorithm>
#include <tuple>

namespace frontalis
{

namespace
{

const std::vector<double>& masses_for_bound(const Discretisation& discretisation)
{
  return discretisation.bound_mass.empty() ? discretisation.node_mass : discretisation.bound_mass;
}

}  // namespace

StepBound bound_of_nodes(const Discretisation& discretisation, const Model& model, const double* stiffness,
                         IndexRange voxels, IndexRange nodes, const std::vector<float>& mobility, double* sum)
{
  std::fill(sum + nodes.first, sum + nodes.last, 0.0);
  for (auto e = voxels.first; e < voxels.last; ++e)
    for (std::size_t corner = 0; corner < 8; ++corner)
      if (const auto node = model.voxel_nodes[e][corner]; node >= nodes.first && node < nodes.last)
        sum[node] += stiffness[e] * discretisation.factor_at(e, corner);
  StepBound bound;
  for (auto n = nodes.first; n < nodes.last; ++n)
    if (mobility[n] > 0)
      bound.add({ sum[n] * double(mobility[n]), n });
  return bound;
}

StepBound step_bound(const Discretisation& discretisation, const Model& model, const std::vector<double>& stiffness,
                     const std::vector<float>& mobility)
{
  std::vector<double> sum(model.nodes.size());
  return bound_of_nodes(discretisation, model, stiffness.data(), { 0, static_cast<std::int32_t>(stiffness.size()) },
                        { 0, static_cast<std::int32_t>(sum.size()) }, mobility, sum.data());
}

std::int32_t stiffest_voxel_at(const Model& model, std::int32_t node, const double* stiffness)
{
  std::int32_t stiffest = -1;
  if (node < 0)
    return stiffest;
  const auto order = [](const auto& a, const auto& b)
  { return std::tie(a[2], a[1], a[0]) < std::tie(b[2], b[1], b[0]); };
  for (int corner = 7; corner >= 0; --corner)
  {
    auto at = model.nodes[node];
    for (int axis = 0; axis < 3; ++axis)
      at[axis] -= corner >> axis & 1;
    const auto found = std::lower_bound(model.voxels.begin(), model.voxels.end(), at, order);
    if (found == model.voxels.end() || order(at, *found))
      continue;
    const auto e = static_cast<std::int32_t>(found - model.voxels.begin());
    if (stiffest < 0 || (!(stiffness[e] <= stiffness[stiffest]) && stiffness[stiffest] == stiffness[stiffest]))
      stiffest = e;
  }
  return stiffest;
}

std::vector<float> mobility(const Discretisation& discretisation)
{
  std::vector<float> result;
  result.reserve(discretisation.node_mass.size());
  for (const double mass : masses_for_bound(discretisation))
    result.push_back(static_cast<float>(1 / mass));
  for (const auto n : discretisation.held)
    result[n] = 0;
  return result;
}

void limit_mobility(const Discretisation& discretisation, IndexRange nodes, const double* sum, double found, bool keeps,
                    std::vector<float>& mobility)
{
  const std::vector<double>& mass = masses_for_bound(discretisation);
  for (auto n = nodes.first; n < nodes.last; ++n)
    if (const double limit = found / sum[n], most = keeps ? mobility[n] : 1 / mass[n]; mobility[n] > 0)
      mobility[n] = static_cast<float>(limit > 0 ? std::min(most, limit) : most);
}

}  // namespace frontalis
