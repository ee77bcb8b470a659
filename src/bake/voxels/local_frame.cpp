#include "bake/voxels/model_stages.hpp"

#include "bake/voxels/voxel_index.hpp"

#include <numeric>
#include <tuple>

namespace frontalis
{
namespace
{

/// Scene axis along which the voxels form the fewest rows, which are therefore the longest.
int longest_rows(const Grid& grid, const Voxels& voxels)
{
  const VoxelIndex index(voxels.place, grid.size);
  std::array<std::size_t, 3> rows{ { 0, 0, 0 } };
  for (const auto& place : voxels.place)
    for (std::size_t a = 0; a < 3; ++a)
    {
      auto before = place;
      --before[a];
      rows[a] += index.find(before) < 0 ? 1 : 0;
    }
  return static_cast<int>(std::min_element(rows.begin(), rows.end()) - rows.begin());
}

}  // namespace

LocalFrame assemble_voxels(const Grid& grid, const Voxels& voxels, Model& model)
{
  LocalFrame frame;
  frame.first = longest_rows(grid, voxels);
  const std::size_t count = voxels.place.size();

  // trim the grid to the voxels
  VoxelPlace lower = voxels.place.front(), upper = lower;
  for (const auto& place : voxels.place)
    for (std::size_t a = 0; a < 3; ++a)
    {
      lower[a] = std::min(lower[a], place[a]);
      upper[a] = std::max(upper[a], place[a]);
    }
  frame.origin = grid.corner(lower);
  model.spacing = to_array(frame.turn(grid.spacing));
  for (int a = 0; a < 3; ++a)
    model.size[a] = upper[frame.scene_axis(a)] - lower[frame.scene_axis(a)] + 1;

  std::vector<VoxelPlace> places(count);
  for (std::size_t e = 0; e < count; ++e)
  {
    places[e] = frame.turn(voxels.place[e]);
    for (int a = 0; a < 3; ++a)
      places[e][a] -= lower[frame.scene_axis(a)];
  }
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t u, std::uint32_t v)
            {
              const auto &p = places[u], &q = places[v];
              return std::tie(p[2], p[1], p[0]) < std::tie(q[2], q[1], q[0]);
            });

  const auto copy = [](const Shares& from, std::uint32_t e, auto& begin, auto& number, auto& share)
  {
    const std::int32_t first = from.begin[e], last = from.begin[e + 1];
    number.insert(number.end(), from.number.begin() + first, from.number.begin() + last);
    share.insert(share.end(), from.share.begin() + first, from.share.begin() + last);
    begin.push_back(static_cast<std::int32_t>(number.size()));
  };
  model.mixture_begin.push_back(0);
  model.fibre_begin.push_back(0);
  for (const std::uint32_t e : order)
  {
    model.voxels.push_back(places[e]);
    model.fill.push_back(voxels.fill[e]);
    if (!voxels.centre.empty())
      model.tissue_centre.push_back(frame.turn(voxels.centre[e]));
    copy(voxels.materials, e, model.mixture_begin, model.mixture_material, model.mixture_proportion);
    copy(voxels.muscles, e, model.fibre_begin, model.fibre_muscle, model.fibre_weight);
  }
  model.fibre_direction.resize(model.fibre_muscle.size());
  return frame;
}

}  // namespace frontalis
