#include "bake/voxels/model_stages.hpp"

#include "bake/voxels/voxel_index.hpp"

#include <map>
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

/// Moves the voxels of flaps (Model::Flap) to planes above all others. An empty plane of voxels lies below each flap,
/// so that the flap shares no node with the voxels below it.
void place_flaps(const Voxels& voxels, std::vector<VoxelPlace>& places, Model& model)
{
  if (voxels.flap.empty())
    return;
  const std::int8_t highest = *std::max_element(voxels.flap.begin(), voxels.flap.end());
  for (std::int8_t f = 1; f <= highest; ++f)
  {
    std::int32_t lowest = model.size[2], top = 0;
    for (std::size_t e = 0; e < places.size(); ++e)
      if (voxels.flap[e] == f)
      {
        lowest = std::min(lowest, places[e][2]);
        top = std::max(top, places[e][2]);
      }
    const std::int32_t first = model.size[2] + 1;
    model.flaps.push_back({ first, first - lowest });
    for (std::size_t e = 0; e < places.size(); ++e)
      if (voxels.flap[e] == f)
        places[e][2] += first - lowest;
    model.size[2] = top + first - lowest + 1;
  }
}

/// Joins the nodes of flaps to nodes of lower flaps or of voxels in no flap. `order`: for each voxel of the model its
/// index in `voxels`; `at`: the grid points of the joints at rest.
void join_flaps(const Voxels& voxels, const std::vector<std::uint32_t>& order, const std::vector<VoxelPlace>& at,
                Model& model)
{
  if (voxels.joints.empty())
    return;
  std::vector<std::int32_t> index(voxels.place.size(), -1);
  for (std::size_t e = 0; e < order.size(); ++e)
    index[order[e]] = static_cast<std::int32_t>(e);
  const auto node = [&](std::uint32_t voxel, const VoxelPlace& p)
  {
    const std::int32_t e = index[voxel];
    const VoxelPlace place = rest_place(model, model.voxels[e]);
    return model.voxel_nodes[e][(p[0] - place[0]) + 2 * (p[1] - place[1]) + 4 * (p[2] - place[2])];
  };
  std::map<std::int32_t, std::int32_t> master;
  for (std::size_t n = 0; n < at.size(); ++n)
    master[node(voxels.joints[n].b, at[n])] = node(voxels.joints[n].a, at[n]);
  for (const auto& [joined, to] : master)
    model.joints.push_back({ joined, to });
}

}  // namespace

std::int32_t LocalFrame::owner(const Model& model, const VoxelIndex& index, const Vector3d& local,
                               const Vector3d& inside) const
{
  if (gaps == nullptr)
    return -1;
  const auto found = gaps->owner(to_scene(local), to_scene(inside));
  if (!found)
    return -1;
  const Vector3d cell = to_local(found->centre).cwiseQuotient(to_vector(model.spacing)).array().floor();
  std::int32_t voxel = index.find({ { static_cast<std::int32_t>(cell[0]), static_cast<std::int32_t>(cell[1]),
                                      static_cast<std::int32_t>(cell[2]) } });
  while (voxel >= 0 && flap_of(model, voxel) != found->flap)
    voxel = index.another(voxel);
  return voxel;
}

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

  const auto local = [&](const VoxelPlace& place)
  {
    VoxelPlace p = frame.turn(place);
    for (int a = 0; a < 3; ++a)
      p[a] -= lower[frame.scene_axis(a)];
    return p;
  };
  std::vector<VoxelPlace> places(count);
  std::transform(voxels.place.begin(), voxels.place.end(), places.begin(), local);
  place_flaps(voxels, places, model);
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0u);
  const auto is_replaced = [&](std::uint32_t e) { return !voxels.flap.empty() && voxels.flap[e] < 0; };
  order.erase(std::remove_if(order.begin(), order.end(), is_replaced), order.end());
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
  build_nodes(model);
  std::vector<VoxelPlace> at;
  for (const Voxels::Joint& joint : voxels.joints)
    at.push_back(local(joint.at));
  join_flaps(voxels, order, at, model);
  return frame;
}

}  // namespace frontalis
