#include "solver/cpu/voxel_rows.hpp"

#include "solver/cpu/gather_tiles.hpp"

#include <algorithm>

namespace frontalis
{
namespace
{

using TileVoxels = std::array<VoxelProperties, Tile::width>;

// Adds the fibres of a tile: one slot per muscle, in ascending order of muscles.
void add_fibres(const Model& model, const TileVoxels& voxels, Tile& tile, std::vector<FibreSlot>& slots,
                std::vector<std::int32_t>& muscles)
{
  tile.fibre_begin = static_cast<std::int32_t>(slots.size());
  for (std::int16_t m = 0; m < static_cast<std::int16_t>(model.muscles.size()); ++m)
  {
    FibreSlot slot{};
    bool any = false;
    for (int lane = 0; lane < Tile::width; ++lane)
    {
      const auto e = tile.voxel(lane);
      if (e < 0)
        continue;
      for (auto f = model.fibre_begin[e]; f < model.fibre_begin[e + 1]; ++f)
        if (model.fibre_muscle[f] == m)
        {
          slot.weight[lane] = static_cast<float>(model.fibre_weight[f] * voxels[lane].tissue_volume *
                                                 model.muscles[m].stress_reference);
          slot.x[lane] = model.fibre_direction[f][0];
          slot.y[lane] = model.fibre_direction[f][1];
          slot.z[lane] = model.fibre_direction[f][2];
          any = true;
        }
    }
    if (any)
    {
      slots.push_back(slot);
      muscles.push_back(m);
    }
  }
  tile.fibre_end = static_cast<std::int32_t>(slots.size());
}

// Adds the laws of a tile other than neo-Hookean: one slot per law whose materials are averaged, and one slot per
// material of the other laws. Unused lanes have valid parameters and the weight 0.
void add_laws(const TileVoxels& voxels, Tile& tile, std::vector<LawSlot>& slots)
{
  tile.law_begin = static_cast<std::int32_t>(slots.size());
  for (int lane = 0; lane < Tile::width; ++lane)
    for (const auto& part : voxels[lane].laws)
    {
      auto slot = std::find_if(slots.begin() + tile.law_begin, slots.end(),
                               [&](const LawSlot& s) { return s.law == part.law && s.material == part.material; });
      if (slot == slots.end())
      {
        LawSlot empty{};
        empty.law = part.law;
        empty.material = part.material;
        for (std::size_t p = 0; p < part.parameters.size(); ++p)
          std::fill(empty.parameters[p], empty.parameters[p] + Tile::width, static_cast<float>(part.parameters[p]));
        slot = slots.insert(slots.end(), empty);
      }
      slot->weight[lane] = static_cast<float>(part.weight * voxels[lane].tissue_volume);
      slot->per_tangent[lane] = static_cast<float>(part.per_tangent);
      slot->at_rest[lane] = static_cast<float>(part.stiffness_at_rest);
      for (std::size_t p = 0; p < part.parameters.size(); ++p)
        slot->parameters[p][lane] = static_cast<float>(part.parameters[p]);
    }
  tile.law_end = static_cast<std::int32_t>(slots.size());
}

void add_viscosity(const TileVoxels& voxels, Tile& tile, std::vector<ViscousSlot>& slots)
{
  tile.viscous = -1;
  ViscousSlot slot{};
  bool any = false;
  for (int lane = 0; lane < Tile::width; ++lane)
    for (int term = 0; term < 2; ++term)
    {
      slot.share[term][lane] = static_cast<float>(voxels[lane].viscous_share[term]);
      slot.rate[term][lane] = static_cast<float>(voxels[lane].viscous_rate[term]);
      any = any || slot.share[term][lane] > 0;
    }
  if (!any)
    return;
  tile.viscous = static_cast<std::int32_t>(slots.size());
  slots.push_back(slot);
}

void add_cut(const Discretisation& discretisation, const TileVoxels& voxels, Tile& tile, std::vector<CutSlot>& slots)
{
  tile.cut = -1;
  CutSlot slot{};
  bool any = false;
  for (int lane = 0; lane < Tile::width; ++lane)
  {
    const auto& c = voxels[lane].centre;
    slot.x[lane] = static_cast<float>(c.x);
    slot.y[lane] = static_cast<float>(c.y);
    slot.z[lane] = static_cast<float>(c.z);
    any = any || c.x != 0 || c.y != 0 || c.z != 0;
    for (std::size_t corner = 0; corner < 8 && tile.voxel(lane) >= 0; ++corner)
      slot.corner[corner][lane] = static_cast<float>(discretisation.factor_at(tile.voxel(lane), corner));
  }
  if (!any)
    return;
  tile.cut = static_cast<std::int32_t>(slots.size());
  slots.push_back(slot);
}

TileStiffness stiffness_of(const TileVoxels& voxels)
{
  TileStiffness s{};
  for (int lane = 0; lane < Tile::width; ++lane)
  {
    const VoxelProperties& v = voxels[lane];
    s.mu[lane] = static_cast<float>(v.mu * v.tissue_volume);
    s.kappa[lane] = static_cast<float>(v.kappa * v.tissue_volume);
    s.stiffening[lane] = static_cast<float>(v.stiffening);
    s.hourglass[lane] = static_cast<float>(v.hourglass);
    s.bound[lane] = static_cast<float>(v.stiffness);
  }
  return s;
}

TileStabilisation stabilisation_of(const TileVoxels& voxels)
{
  TileStabilisation s{};
  for (int lane = 0; lane < Tile::width; ++lane)
  {
    const auto& k = voxels[lane].stabilisation;
    s.bending[lane] = static_cast<float>(k.bending);
    s.coupling[lane] = static_cast<float>(k.coupling);
    s.torsion[lane] = static_cast<float>(k.torsion);
    s.warping[lane] = static_cast<float>(k.warping);
  }
  return s;
}

}  // namespace

VoxelRows::VoxelRows(const Model& model, const Discretisation& discretisation)
{
  planes = model.size[2] + 1;
  plane_tiles.assign(planes + 1, 0);
  plane_nodes.assign(planes + 1, 0);
  for (const auto& node : model.nodes)
    ++plane_nodes[node[2] + 1];
  for (std::int32_t k = 0; k < planes; ++k)
    plane_nodes[k + 1] += plane_nodes[k];

  plane_voxels.assign(planes + 1, 0);
  for (const auto& voxel : model.voxels)
    ++plane_voxels[voxel[2] + 1];
  for (std::int32_t k = 0; k < planes; ++k)
    plane_voxels[k + 1] += plane_voxels[k];

  for (std::int32_t k = 0; k < planes; ++k)
  {
    const std::int32_t first = plane_voxels[k], last = plane_voxels[k + 1];
    std::vector<VoxelProperties> properties(last - first);
    for (auto e = first; e < last; ++e)
      discretisation.voxel(e, properties[e - first]);
    for (Tile& tile : gather_tiles(model, first, last, properties.data()))
    {
      TileVoxels voxels;
      for (int lane = 0; lane < Tile::width; ++lane)
        if (tile.voxel(lane) >= 0)
          voxels[lane] = properties[tile.voxel(lane) - first];
      add_fibres(model, voxels, tile, fibres, fibre_muscle);
      add_laws(voxels, tile, laws);
      add_viscosity(voxels, tile, viscous);
      add_cut(discretisation, voxels, tile, cut);
      tile.simple = tile.law_begin == tile.law_end && tile.viscous < 0 && tile.cut < 0;
      stiffness.push_back(stiffness_of(voxels));
      if (discretisation.assumed_strain)
        stabilisation.push_back(stabilisation_of(voxels));
      tiles.push_back(tile);
      ++plane_tiles[k + 1];
    }
  }
  for (std::int32_t k = 0; k < planes; ++k)
    plane_tiles[k + 1] += plane_tiles[k];
  tiles.shrink_to_fit();
  stiffness.shrink_to_fit();
  stabilisation.shrink_to_fit();
  fibres.shrink_to_fit();
  fibre_muscle.shrink_to_fit();
  laws.shrink_to_fit();
  viscous.shrink_to_fit();
  cut.shrink_to_fit();
}

void VoxelRows::renew_bounds(const Discretisation& discretisation)
{
  VoxelProperties voxel;
  for (std::size_t t = 0; t < tiles.size(); ++t)
    for (int lane = 0; lane < Tile::width; ++lane)
      if (const auto e = tiles[t].voxel(lane); e >= 0)
      {
        discretisation.voxel(static_cast<std::size_t>(e), voxel);
        stiffness[t].bound[lane] = static_cast<float>(voxel.stiffness);
      }
}

void VoxelRows::list_arrays(Effect of_fibres, ArrayList& list) const
{
  list.add("tiles", tiles);
  list.add("planes", plane_tiles);
  list.add("planes", plane_nodes);
  list.add("planes", plane_voxels);
  list.add("stiffness", stiffness);
  list.add("hourglass stiffness", stabilisation);
  list.add("laws", laws);
  list.add(of_fibres, "fibres", fibres);
  list.add(of_fibres, "fibres", fibre_muscle);
  list.add(Effect::viscosity, "Prony terms", viscous);
  list.add(Effect::cut_voxels, "centroids of tissue", cut);
}

}  // namespace frontalis
