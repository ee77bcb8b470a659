#include "bake/messages.hpp"
#include "bake/voxels/model_stages.hpp"
#include "bake/voxels/voxel_index.hpp"

#include <boost/pending/disjoint_sets.hpp>

namespace frontalis
{
namespace
{

/// Returns for each voxel the index of its component. Voxels of a component are connected by faces. `sizes` receives
/// the number of voxels in each component.
std::vector<std::int32_t> face_components(const Model& model, std::vector<std::size_t>& sizes)
{
  const VoxelIndex index(model.voxels, model.size);
  const std::size_t count = model.voxels.size();
  boost::disjoint_sets_with_storage<> parts(count);
  for (std::size_t e = 0; e < count; ++e)
    for (std::size_t a = 0; a < 3; ++a)
    {
      auto place = model.voxels[e];
      --place[a];
      if (const std::int32_t other = index.find(place); other >= 0)
        parts.union_set(e, static_cast<std::size_t>(other));
    }
  if (!model.joints.empty())
  {
    std::vector<std::size_t> voxel_of(model.nodes.size());
    for (std::size_t e = 0; e < count; ++e)
      for (const std::int32_t n : model.voxel_nodes[e])
        voxel_of[n] = e;
    for (const Model::Joint& joint : model.joints)
      parts.union_set(voxel_of[joint.node], voxel_of[joint.master]);
  }
  std::vector<std::int32_t> number(count, -1), component(count);
  for (std::size_t e = 0; e < count; ++e)
  {
    std::int32_t& own = number[parts.find_set(e)];
    if (own < 0)
    {
      own = static_cast<std::int32_t>(sizes.size());
      sizes.push_back(0);
    }
    component[e] = own;
    ++sizes[own];
  }
  return component;
}

/// Renumbers restricted nodes and removes those without a new number (-1).
template <class Restricted>
void renumber(std::vector<Restricted>& list, const std::vector<std::int32_t>& number)
{
  std::size_t kept = 0;
  for (Restricted entry : list)
  {
    entry.node = number[entry.node];
    if (entry.node >= 0)
      list[kept++] = entry;
  }
  list.resize(kept);
}

/// Keeps the entries of the voxels that stay. In each list, voxel e has the entries begin[e] .. begin[e + 1].
template <class... Lists>
void keep_entries(const std::vector<bool>& keep, std::vector<std::int32_t>& begin, Lists&... lists)
{
  std::vector<std::int32_t> kept{ 0 };
  std::int32_t count = 0;
  for (std::size_t e = 0; e < keep.size(); ++e)
  {
    if (!keep[e])
      continue;
    for (std::int32_t m = begin[e]; m < begin[e + 1]; ++m, ++count)
      ((lists[count] = lists[m]), ...);
    kept.push_back(count);
  }
  begin = std::move(kept);
  (lists.resize(count), ...);
}

void keep_voxels(Model& model, const std::vector<bool>& keep)
{
  keep_entries(keep, model.mixture_begin, model.mixture_material, model.mixture_proportion);
  keep_entries(keep, model.fibre_begin, model.fibre_muscle, model.fibre_weight, model.fibre_direction);
  std::size_t kept = 0;
  for (std::size_t e = 0; e < keep.size(); ++e)
  {
    if (!keep[e])
      continue;
    model.voxels[kept] = model.voxels[e];
    if (!model.tissue_centre.empty())
      model.tissue_centre[kept] = model.tissue_centre[e];
    model.fill[kept++] = model.fill[e];
  }
  model.voxels.resize(kept);
  model.fill.resize(kept);
  model.tissue_centre.resize(model.tissue_centre.empty() ? 0 : kept);

  // the nodes that stay keep their order
  const std::vector<std::array<std::int32_t, 3>> old = std::move(model.nodes);
  build_nodes(model);
  std::vector<std::int32_t> number(old.size(), -1);
  std::size_t at = 0;
  for (std::size_t n = 0; n < old.size() && at < model.nodes.size(); ++n)
    if (old[n] == model.nodes[at])
      number[n] = static_cast<std::int32_t>(at++);
  renumber(model.rigid, number);
  renumber(model.sliding, number);
  renumber(model.prescribed, number);
  renumber(model.joints, number);
  for (Model::Joint& joint : model.joints)
    joint.master = number[joint.master];
}

}  // namespace

void remove_islands(Model& model, BakeMonitor& monitor)
{
  std::vector<std::size_t> sizes;
  const std::vector<std::int32_t> component = face_components(model, sizes);
  if (sizes.size() < 2)
    return;
  std::vector<bool> restricted(model.nodes.size(), false);
  const auto mark = [&restricted](const auto& nodes)
  {
    for (const auto& entry : nodes)
      restricted[entry.node] = true;
  };
  mark(model.rigid);
  mark(model.sliding);
  mark(model.prescribed);
  std::vector<bool> held(sizes.size(), false);
  for (std::size_t e = 0; e < component.size(); ++e)
    for (const std::int32_t n : model.voxel_nodes[e])
      if (restricted[n])
        held[component[e]] = true;

  const std::size_t largest = std::max_element(sizes.begin(), sizes.end()) - sizes.begin();
  std::vector<bool> stays(sizes.size());
  std::size_t islands = 0, crumbs = 0, voxels = 0;
  for (std::size_t c = 0; c < sizes.size(); ++c)
  {
    stays[c] = c == largest || (held[c] && 100 * sizes[c] >= sizes[largest]);
    if (stays[c])
      continue;
    (held[c] ? crumbs : islands) += 1;  // `crumbs`: small components with restricted nodes
    voxels += sizes[c];
  }
  if (voxels == 0)
    return;
  std::vector<bool> keep(component.size());
  for (std::size_t e = 0; e < keep.size(); ++e)
    keep[e] = stays[component[e]];
  keep_voxels(model, keep);
  monitor.found("{} removed: {} that nothing holds and {} connected to the rest by no face of a voxel",
                count_text(voxels, "voxel", "voxels"), count_text(islands, "island", "islands"),
                count_text(crumbs, "small part", "small parts"));
}

}  // namespace frontalis
