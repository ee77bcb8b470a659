#pragma once

#include "block_model.hpp"

#include <algorithm>

namespace frontalis
{
namespace test
{

/// A condition on a column of voxels or nodes, i.e. on their place along x.
using Columns = std::function<bool(std::int32_t)>;

/// Parts a box of voxels along its plane `middle`, which is normal to z. The voxels above become a flap with nodes of
/// its own.
inline void part(Model& model, std::int32_t middle, const Columns& parted)
{
  const std::int32_t first = model.size[2] + 1, shift = first - middle;
  for (auto& voxel : model.voxels)
    if (voxel[2] >= middle && parted(voxel[0]))
      voxel[2] += shift;
  std::sort(model.voxels.begin(), model.voxels.end(),
            [](const auto& a, const auto& b)
            { return std::lexicographical_compare(a.rbegin(), a.rend(), b.rbegin(), b.rend()); });
  model.flaps = { { first, shift } };
  model.size[2] += shift;
  build_nodes(model);
}

/// Index of the node at a place of the grid; -1 if there is none.
inline std::int32_t node_at(const Model& model, const std::array<std::int32_t, 3>& place)
{
  const auto found = std::find(model.nodes.begin(), model.nodes.end(), place);
  return found == model.nodes.end() ? -1 : static_cast<std::int32_t>(found - model.nodes.begin());
}

/// Joins nodes of the flap to the nodes that rest at the same places.
inline void join(
    Model& model, const Columns& joined = [](std::int32_t) { return true; })
{
  for (std::size_t n = 0; n < model.nodes.size(); ++n)
  {
    const auto place = rest_place(model, model.nodes[n]);
    if (place != model.nodes[n] && joined(place[0]) && node_at(model, place) >= 0)
      model.joints.push_back({ static_cast<std::int32_t>(n), node_at(model, place) });
  }
}

}  // namespace test
}  // namespace frontalis
