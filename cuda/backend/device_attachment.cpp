#include "cuda/backend/device_attachment.hpp"

#include "frontalis/model/sample_field.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <unordered_map>

namespace frontalis
{
namespace cuda
{
namespace
{

void put(const physics::Vec3<double>& from, float (&to)[3])
{
  to[0] = static_cast<float>(from.x);
  to[1] = static_cast<float>(from.y);
  to[2] = static_cast<float>(from.z);
}

}  // namespace

AttachedTables::AttachedTables(const Model& model, const std::vector<double>& mass,
                               const std::vector<std::uint32_t>& device_node, const VoxelPatches* patches)
{
  const std::vector<AttachedNode> nodes = nodes_by_master(model);
  const std::vector<std::array<bool, 3>> fixed = prescribed_axes(model);
  for (std::size_t begin = 0, end = 0; begin < nodes.size(); begin = end)
  {
    const std::int32_t master = nodes[begin].master;
    AttachedGroup group{};
    put(rest_point(model, master), group.rest);
    group.mass = static_cast<float>(mass[master]);
    group.master = device_node[master];
    for (std::uint32_t axis = 0; axis < 3; ++axis)
      group.fixed |= fixed[master][axis] ? 1u << axis : 0u;
    group.first = static_cast<std::int32_t>(ties.size());
    for (; end < nodes.size() && nodes[end].master == master; ++end)
    {
      const AttachedNode& node = nodes[end];
      AttachedTie tie{};
      put(rest_point(model, node.node), tie.rest);
      tie.ratio = static_cast<float>(node.ratio);
      tie.mass = static_cast<float>(mass[node.node]);
      tie.node = device_node[node.node];
      tie.bone = node.bone;
      tie.plane = tie.master_plane = -1;
      if (node.surface >= 0)
      {
        tie.bone = model.constraint_surfaces[node.surface].bone;
        tie.offset = static_cast<float>(level_offset(model, node));
        // one per tie, because the threads of a group take its ties at the same time
        tie.master_plane = add_place(model, master, node.surface);
        tie.plane = add_place(model, node.node, node.surface);
      }
      ties.push_back(tie);
    }
    group.last = static_cast<std::int32_t>(ties.size());
    groups.push_back(group);
  }
  const auto patch_of = [&](const AttachedGroup& group)
  { return patches != nullptr ? patches->patch_of(group.master) : std::size_t{ 0 }; };
  // The threads of a warp do the same, and read nodes that are close to each other.
  const auto key = [&](const AttachedGroup& group)
  {
    const bool slides = std::any_of(ties.begin() + group.first, ties.begin() + group.last,
                                    [](const AttachedTie& tie) { return tie.plane >= 0; });
    return std::make_tuple(patch_of(group), slides, group.master);
  };
  std::sort(groups.begin(), groups.end(),
            [&](const AttachedGroup& a, const AttachedGroup& b) { return key(a) < key(b); });
  if (patches == nullptr)
    return;
  patch_groups.assign(patches->patches.size() + 1, 0);
  for (const AttachedGroup& group : groups)
    ++patch_groups[patch_of(group) + 1];
  std::partial_sum(patch_groups.begin(), patch_groups.end(), patch_groups.begin());
}

std::int32_t AttachedTables::add_place(const Model& model, std::int32_t node, std::int32_t surface)
{
  const SampledField& field = model.constraint_surfaces[surface].field;
  const auto point = physics::field_point(view(field), rest_point(model, node));
  AttachedPlace place{ {}, 0, { point.cell[0], point.cell[1], point.cell[2] }, surface };
  put(point.offset, place.offset);
  place.distance = static_cast<float>(norm(point.offset) - field.radius);
  places.push_back(place);
  return static_cast<std::int32_t>(places.size()) - 1;
}

DeviceAttachment::DeviceAttachment(const Model& model, const std::vector<double>& mass,
                                   const std::vector<std::uint32_t>& device_node, const VoxelPatches* patches)
    : DeviceAttachment(AttachedTables(model, mass, device_node, patches))
{
}

DeviceAttachment::DeviceAttachment(const AttachedTables& tables)
    : host_groups_(tables.groups),
      host_ties_(tables.ties),
      groups_(tables.groups),
      ties_(tables.ties),
      places_(tables.places),
      planes_(tables.places.size()),
      patch_groups_(tables.patch_groups)
{
  reset();
}

void DeviceAttachment::masses_changed(const std::vector<InverseMass>& masses)
{
  if (empty())
    return;
  std::unordered_map<std::uint32_t, float> mass_of;
  for (const InverseMass& mass : masses)
    mass_of[mass.node] = 1 / mass.own;
  const auto change = [&](auto& entries, auto& array, auto node_of)
  {
    bool changed = false;
    for (auto& entry : entries)
      if (const auto found = mass_of.find(node_of(entry)); found != mass_of.end())
      {
        entry.mass = found->second;
        changed = true;
      }
    if (changed)
      array.upload(entries.data(), entries.size());
  };
  change(host_groups_, groups_, [](const AttachedGroup& group) { return group.master; });
  change(host_ties_, ties_, [](const AttachedTie& tie) { return tie.node; });
}

void DeviceAttachment::describe(StepArguments& g) const
{
  g.attached = { groups_.data(), static_cast<std::uint32_t>(groups_.size()),
                 ties_.data(),   places_.data(),
                 planes_.data(), patch_groups_.data() };
}

void DeviceAttachment::list_arrays(ArrayList& list)
{
  list.add(Effect::attachment, "attached nodes",
           groups_.bytes() + ties_.bytes() + places_.bytes() + patch_groups_.bytes());
  list_state(list, Effect::attachment, "tangent planes", planes_);
}

}  // namespace cuda
}  // namespace frontalis
