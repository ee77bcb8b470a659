#include "cuda/partition/voxel_patches.hpp"

#include "frontalis/error.hpp"
#include "frontalis/model/effects.hpp"
#include "frontalis/physics/mutation.hpp"
#include "solver/stepping/attached_nodes.hpp"

#include <algorithm>
#include <numeric>
#include <string>
#include <tuple>

namespace frontalis
{
namespace
{

// Costs relative to a voxel without effects. They were measured on blocks in which all voxels or none have the effect.
// The cost of nodes that slide on moving bones was chosen to minimise the wall time per step of the generated head,
// when these nodes were still computed in double precision. That of nodes that follow a master is an estimate.
constexpr float fibre_cost = 0.4f, viscous_cost = 0.45f, node_cost = 0.8f, glide_cost = 5, follower_cost = 2;

std::int32_t fibres_of(const Model& model, std::size_t e) { return model.fibre_begin[e + 1] - model.fibre_begin[e]; }

std::vector<float> voxel_costs(const Model& model, const BoundWork& bound)
{
  std::vector<float> cost = bound.cost;
  cost.resize(model.voxels.size(), 0);
  for (std::size_t e = 0; e < cost.size(); ++e)
    cost[e] += 1 + fibre_cost * static_cast<float>(fibres_of(model, e)) + (is_viscous(model, e) ? viscous_cost : 0);
  return cost;
}

std::vector<float> node_costs(const Model& model)
{
  std::vector<float> cost(model.nodes.size(), node_cost);
  for (const SlidingNode& node : model.sliding)
    cost[node.node] += model.constraint_surfaces[node.surface].bone >= 0 ? glide_cost : 0;
  for (const auto& node : nodes_by_master(model))
    cost[node.node] += follower_cost;
  return cost;
}

// Recursive bisection of nodes by weight. Each cut is along the plane with the fewest nodes.
class Bisection
{
public:
  Bisection(const Model& model, const std::vector<float>& weight)
      : part_of(model.nodes.size()), model_(model), weight_(weight), order_(model.nodes.size())
  {
    std::iota(order_.begin(), order_.end(), 0u);
    for (const auto& node : model.nodes)
      place_.push_back(rest_place(model, node));
  }

  void cut(int parts)
  {
    cut(0, order_.size(), 0, parts);
    order_ = {};
  }

  std::vector<std::uint32_t> part_of;  ///< part of each node

private:
  struct Plane
  {
    int axis = 0;
    std::int32_t at = 0;
    double before = 0;  // weight of the nodes before the plane
    std::size_t section = 0;
  };

  Plane find(std::size_t first, std::size_t last, double share)
  {
    Plane best;
    for (int axis = 0; axis < 3; ++axis)
    {
      sum_.assign(model_.size[axis] + 1, 0);
      count_.assign(model_.size[axis] + 1, 0);
      double total = 0;
      for (std::size_t n = first; n < last; ++n)
      {
        const std::int32_t at = place_[order_[n]][axis];
        sum_[at] += weight_[order_[n]];
        ++count_[at];
        total += weight_[order_[n]];
      }
      Plane plane;
      plane.axis = axis;
      while (plane.at < model_.size[axis] && plane.before + sum_[plane.at] <= share * total)
        plane.before += sum_[plane.at++];
      plane.section = count_[plane.at];
      if (axis == 0 || plane.section < best.section)
      {
        best = plane;
        missing_ = share * total - plane.before;
      }
    }
    return best;
  }

  void cut(std::size_t first, std::size_t last, std::uint32_t part, int parts)
  {
    if (parts == 1 || first == last)
    {
      for (std::size_t n = first; n < last; ++n)
        part_of[order_[n]] = part;
      return;
    }
    const int low = parts / 2;
    const Plane plane = find(first, last, static_cast<double>(low) / parts);
    const auto coordinate = [&](std::uint32_t n) { return place_[n][plane.axis]; };
    const auto begin = order_.begin() + static_cast<std::ptrdiff_t>(first),
               end = order_.begin() + static_cast<std::ptrdiff_t>(last);
    // The nodes of the plane stay in the model's order, so that a cut within the plane runs along a row.
    const auto within = std::stable_partition(begin, end, [&](std::uint32_t n) { return coordinate(n) < plane.at; });
    const auto after = std::stable_partition(within, end, [&](std::uint32_t n) { return coordinate(n) == plane.at; });
    auto middle = within;
    for (double missing = missing_; middle < after && missing > 0.5 * weight_[*middle]; ++middle)
      missing -= weight_[*middle];
    const auto half = static_cast<std::size_t>(middle - order_.begin());
    cut(first, half, part, low);
    cut(half, last, part + static_cast<std::uint32_t>(low), parts - low);
  }

  const Model& model_;
  const std::vector<float>& weight_;
  std::vector<std::uint32_t> order_;
  std::vector<std::array<std::int32_t, 3>> place_;  // of each node at rest
  std::vector<double> sum_;
  std::vector<std::size_t> count_;
  double missing_ = 0;
};

// Calls call(part, voxel) once for each part that owns a corner of the voxel.
template <class Call>
void each_part(const Model& model, const std::vector<std::uint32_t>& part_of, const Call& call)
{
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
  {
    std::uint32_t seen[8];
    int count = 0;
    for (const auto n : model.voxel_nodes[e])
      if (std::find(seen, seen + count, part_of[n]) == seen + count)
        call(seen[count++] = part_of[n], static_cast<std::uint32_t>(e));
  }
}

// Divides the model into parts of about equal cost. Iterates, because shared voxels, and thus the cost, depend on the
// cut.
std::vector<std::uint32_t> partition(const Model& model, const BoundWork& bound, int parts)
{
  const std::vector<float> of_voxel = voxel_costs(model, bound), of_node = node_costs(model);
  const auto followers = nodes_by_master(model);
  std::vector<float> weight = of_node;
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
    for (const auto n : model.voxel_nodes[e])
      weight[n] += 0.125f * of_voxel[e];
  std::vector<std::uint32_t> best;
  double least = 0;
  for (int round = 0; round < 6; ++round)
  {
    Bisection bisection(model, weight);
    bisection.cut(parts);
    // A part has all nodes of a group, so that it needs no others to move them.
    for (const auto& node : followers)
      bisection.part_of[node.node] = bisection.part_of[node.master];
    std::vector<double> cost(parts, 0);
    for (std::size_t n = 0; n < of_node.size(); ++n)
      cost[bisection.part_of[n]] += of_node[n];
    each_part(model, bisection.part_of, [&](std::uint32_t part, std::uint32_t e) { cost[part] += of_voxel[e]; });
    const double mean = std::accumulate(cost.begin(), cost.end(), 0.0) / parts;
    for (std::size_t n = 0; n < weight.size(); ++n)
      weight[n] *= static_cast<float>(cost[bisection.part_of[n]] / mean);
    const double most = *std::max_element(cost.begin(), cost.end());
    if (best.empty() || most < least)
    {
      best = std::move(bisection.part_of);
      least = most;
    }
  }
  return best;
}

// Class of each node: 1 if it is prescribed or moves with a bone, 2 if it slides on a surface that moves, 3 if it
// slides on one that stands still, else 0. The nodes of a class have contiguous numbers, because a warp takes as long
// for one node with effects as for 32.
std::vector<char> busy_nodes(const Model& model)
{
  std::vector<char> busy(model.nodes.size(), 0);
  for (const SlidingNode& node : model.sliding)
    busy[node.node] = model.constraint_surfaces[node.surface].bone >= 0 ? 2 : 3;
  for (const auto& node : model.prescribed)
    busy[node.node] = 1;
  for (const auto& node : model.rigid)
    busy[node.node] = node.bone >= 0 ? 1 : 0;
  return busy;
}

}  // namespace

VoxelPatches::VoxelPatches(const Model& model, const PatchSettings& settings, const BoundWork& bound)
    : blocks(static_cast<std::uint32_t>(settings.blocks))
{
  const int parts = settings.blocks * settings.turns;
  const auto part_of = partition(model, bound, parts);
  std::vector<std::vector<std::uint32_t>> nodes_of(parts), voxels_of(parts);
  std::vector<char> on_border(model.nodes.size(), 0);
  each_part(model, part_of, [&](std::uint32_t part, std::uint32_t e) { voxels_of[part].push_back(e); });
  // The entries are model nodes at first and are replaced by device nodes below.
  std::vector<std::vector<std::uint32_t>> halo_of(parts);
  for (int p = 0; p < parts; ++p)
  {
    const auto add = [&](std::uint32_t e)
    {
      for (const auto n : model.voxel_nodes[e])
        if (part_of[n] != static_cast<std::uint32_t>(p))
        {
          halo_of[p].push_back(static_cast<std::uint32_t>(n));
          on_border[n] = 1;
        }
    };
    for (const auto e : voxels_of[p])
    {
      add(e);
      if (!bound.beside.empty())
        for (const auto other : bound.beside[e])
          add(static_cast<std::uint32_t>(other));
    }
  }
  const auto busy = busy_nodes(model);
  for (const char border : { 1, 0 })
    for (const char kind : { 3, 2, 1, 0 })
      for (std::size_t n = 0; n < model.nodes.size(); ++n)
        if (on_border[n] == border && busy[n] == kind)
          nodes_of[part_of[n]].push_back(static_cast<std::uint32_t>(n));
  number_nodes(model.nodes.size(), nodes_of);
  for (int p = 0; p < parts; ++p)
  {
    patches[p].border = static_cast<std::uint32_t>(
        std::count_if(nodes_of[p].begin(), nodes_of[p].end(), [&](std::uint32_t n) { return on_border[n] != 0; }));
    most_voxels = std::max(most_voxels, static_cast<std::uint32_t>(voxels_of[p].size()));
  }

  // Halos are sorted by device node, so that neighbouring threads read neighbouring nodes.
  for (int p = 0; p < parts; ++p)
  {
    auto& nodes = halo_of[p];
    for (auto& n : nodes)
      n = device_node[n];
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    patches[p].halo_begin = static_cast<std::uint32_t>(halo.size());
    patches[p].halo = static_cast<std::uint32_t>(nodes.size());
    halo.insert(halo.end(), nodes.begin(), nodes.end());
    most_halo = std::max(most_halo, patches[p].halo);
    const auto rank = [&](std::uint32_t e)
    { return std::make_tuple(has_law(model, e), is_viscous(model, e), fibres_of(model, e)); };
    std::stable_sort(voxels_of[p].begin(), voxels_of[p].end(),
                     [&](std::uint32_t a, std::uint32_t b) { return rank(a) > rank(b); });
    const auto count = [&](const auto& is)
    { return static_cast<std::uint32_t>(std::count_if(voxels_of[p].begin(), voxels_of[p].end(), is)); };
    patches[p].laws = count([&](std::uint32_t e) { return has_law(model, e); });
    patches[p].special =
        count([&](std::uint32_t e) { return rank(e) > std::make_tuple(false, false, std::int32_t{ 0 }); });
  }

  std::array<std::uint16_t, 8> none{};
  none.fill(static_cast<std::uint16_t>(most_voxels));
  node_voxel.assign(model.nodes.size() + 1, none);
  std::vector<std::uint32_t> filled(settings.blocks, 0);
  for (int p = 0; p < parts; ++p)
  {
    Patch& patch = patches[p];
    patch.voxel_begin = static_cast<std::uint32_t>(voxel.size());
    patch.voxels = static_cast<std::uint32_t>(voxels_of[p].size());
    first_place.push_back(most_halo + filled[p % settings.blocks]);
    add_patch(model, static_cast<std::size_t>(p), voxels_of[p]);
    filled[p % settings.blocks] += patch.nodes;
    most_nodes = std::max(most_nodes, filled[p % settings.blocks]);
  }
  // Indices have 16 bits. If they do not suffice, the caller tries smaller patches, or strips.
  fits_indices = most_halo + most_nodes <= 65535 && most_voxels < 65535;
}

void VoxelPatches::number_nodes(std::size_t count, const std::vector<std::vector<std::uint32_t>>& nodes_of)
{
  device_node.assign(count, 0);
  std::uint32_t next = 1;
  for (const auto& nodes : nodes_of)
  {
    patches.push_back({ next, static_cast<std::uint32_t>(nodes.size()), 0, 0, 0, 0, 0, 0, 0 });
    for (const auto n : nodes)
      device_node[n] = next++;
  }
}

std::size_t VoxelPatches::patch_of(std::uint32_t node) const
{
  const auto after = std::upper_bound(patches.begin(), patches.end(), node,
                                      [](std::uint32_t n, const Patch& patch) { return n < patch.first_node; });
  return static_cast<std::size_t>(after - patches.begin()) - 1;
}

std::uint32_t VoxelPatches::place_of(std::size_t index, std::uint32_t node) const
{
  const Patch& patch = patches[index];
  if (node >= patch.first_node && node < patch.first_node + patch.nodes)
    return first_place[index] + node - patch.first_node;
  const auto first = halo.begin() + patch.halo_begin;
  return static_cast<std::uint32_t>(std::lower_bound(first, first + patch.halo, node) - first);
}

std::uint32_t VoxelPatches::most_in_patch(const std::vector<std::uint32_t>& in_voxel) const
{
  std::uint32_t most = 0;
  for (const Patch& patch : patches)
  {
    const auto first = voxel.begin() + patch.voxel_begin;
    most = std::max(most, std::accumulate(first, first + patch.voxels, 0u,
                                          [&](std::uint32_t sum, std::uint32_t e) { return sum + in_voxel[e]; }));
  }
  return most;
}

void VoxelPatches::add_patch(const Model& model, std::size_t index, const std::vector<std::uint32_t>& voxels)
{
  const Patch& patch = patches[index];
  for (std::size_t v = 0; v < voxels.size(); ++v)
  {
    std::array<std::uint16_t, 8> places{};
    for (int b = 0; b < 8; ++b)
    {
      const std::uint32_t node = device_node[model.voxel_nodes[voxels[v]][b]];
      const bool own = node >= patch.first_node && node < patch.first_node + patch.nodes;
      if (own && !(mutation::lost_corner && b == 0))
        node_voxel[node][b] = static_cast<std::uint16_t>(v);
      places[b] = static_cast<std::uint16_t>(place_of(index, node));
    }
    corner.push_back(places);
    voxel.push_back(voxels[v]);
  }
}

}  // namespace frontalis
