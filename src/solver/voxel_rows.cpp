#include "voxel_rows.hpp"

#include <algorithm>

namespace frontalis
{
namespace
{

// the fibres of a tile, one slot a muscle, muscles ascending
void add_fibres(const Model& model, const std::vector<double>& tissue_volume, Tile& tile, std::vector<FibreSlot>& slots)
{
  tile.fibre_begin = static_cast<std::int32_t>(slots.size());
  for (std::int16_t m = 0; m < static_cast<std::int16_t>(model.muscles.size()); ++m)
  {
    FibreSlot slot{};
    slot.muscle = m;
    bool any = false;
    for (int lane = 0; lane < tile.count; ++lane)
    {
      const auto e = tile.first_voxel + lane;
      for (auto f = model.fibre_begin[e]; f < model.fibre_begin[e + 1]; ++f)
        if (model.fibre_muscle[f] == m)
        {
          slot.weight[lane] =
              static_cast<float>(model.fibre_weight[f] * tissue_volume[e] * model.muscles[m].stress_reference);
          slot.x[lane] = model.fibre_direction[f][0];
          slot.y[lane] = model.fibre_direction[f][1];
          slot.z[lane] = model.fibre_direction[f][2];
          any = true;
        }
    }
    if (any)
      slots.push_back(slot);
  }
  tile.fibre_end = static_cast<std::int32_t>(slots.size());
}

}  // namespace

VoxelRows::VoxelRows(const Model& model, const std::vector<double>& tissue_volume)
{
  planes = model.size[2] + 1;
  plane_tiles.assign(planes + 1, 0);
  plane_nodes.assign(planes + 1, 0);
  for (const auto& node : model.nodes)
    ++plane_nodes[node[2] + 1];
  for (std::int32_t k = 0; k < planes; ++k)
    plane_nodes[k + 1] += plane_nodes[k];

  const auto count = static_cast<std::int32_t>(model.voxels.size());
  for (std::int32_t e = 0; e < count;)
  {
    const auto& first = model.voxels[e];
    Tile tile{};
    tile.first_voxel = e;
    for (int row = 0; row < 4; ++row)
      tile.node[row] = model.voxel_nodes[e][2 * row];
    while (e < count && tile.count < Tile::width && model.voxels[e][2] == first[2] && model.voxels[e][1] == first[1] &&
           model.voxels[e][0] == first[0] + tile.count)
    {
      ++tile.count;
      ++e;
    }
    add_fibres(model, tissue_volume, tile, fibres);
    tiles.push_back(tile);
    ++plane_tiles[first[2] + 1];
  }
  for (std::int32_t k = 0; k < planes; ++k)
    plane_tiles[k + 1] += plane_tiles[k];
}

std::vector<float> VoxelRows::blocks(const std::vector<double>& values) const
{
  std::vector<float> result(tiles.size() * Tile::width, 0.0f);
  for (std::size_t t = 0; t < tiles.size(); ++t)
    for (int lane = 0; lane < tiles[t].count; ++lane)
      result[t * Tile::width + lane] = static_cast<float>(values[tiles[t].first_voxel + lane]);
  return result;
}

}  // namespace frontalis
