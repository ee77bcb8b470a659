#include "cuda/backend/device_attachment.hpp"

#include "frontalis/model/sample_field.hpp"

#include <algorithm>
#include <tuple>

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

// Nodes that follow the same master.
struct GroupRange
{
  const AttachedNode *begin, *end;
};

std::vector<GroupRange> groups_of(const std::vector<AttachedNode>& nodes_by_master)
{
  std::vector<GroupRange> groups;
  for (const AttachedNode& node : nodes_by_master)
  {
    if (groups.empty() || groups.back().begin->master != node.master)
      groups.push_back({ &node, &node });
    ++groups.back().end;
  }
  return groups;
}

std::int32_t sliding_nodes(const GroupRange& group)
{
  return static_cast<std::int32_t>(
      std::count_if(group.begin, group.end, [](const AttachedNode& node) { return node.surface >= 0; }));
}

}  // namespace

std::uint32_t most_group_words(const Model& model, const VoxelPatches& patches)
{
  std::vector<std::uint32_t> words(patches.blocks, 0);
  const std::vector<AttachedNode> nodes = nodes_by_master(model);
  for (const GroupRange& group : groups_of(nodes))
  {
    const PatchGroups all{ 1, static_cast<std::int32_t>(group.end - group.begin), 2 * sliding_nodes(group) };
    words[patches.patch_of(patches.device_node[group.begin->master]) % patches.blocks] += group_words({}, all);
  }
  return *std::max_element(words.begin(), words.end());
}

AttachedTables::AttachedTables(const Model& model, const std::vector<double>& mass,
                               const std::vector<std::uint32_t>& device_node, const VoxelPatches* patches)
{
  // The threads of a warp do the same, and read nodes that are close to each other.
  const std::vector<AttachedNode> nodes = nodes_by_master(model);
  std::vector<GroupRange> ranges = groups_of(nodes);
  const auto patch_of = [&](const GroupRange& group)
  { return patches != nullptr ? patches->patch_of(device_node[group.begin->master]) : std::size_t{ 0 }; };
  const auto key = [&](const GroupRange& group)
  { return std::make_tuple(patch_of(group), sliding_nodes(group) > 0, device_node[group.begin->master]); };
  std::sort(ranges.begin(), ranges.end(), [&](const GroupRange& a, const GroupRange& b) { return key(a) < key(b); });
  const std::vector<std::array<bool, 3>> fixed = prescribed_axes(model);
  const auto close_patches = [&](std::size_t count)
  {
    const PatchGroups next{ static_cast<std::uint32_t>(groups.size()), static_cast<std::int32_t>(ties.size()),
                            static_cast<std::int32_t>(places.size()) };
    patch_groups.resize(std::max(patch_groups.size(), count), next);
  };
  for (const GroupRange& range : ranges)
  {
    if (patches != nullptr)
      close_patches(patch_of(range) + 1);
    add_group(model, mass, device_node, range.begin, range.end);
    for (std::uint32_t axis = 0; axis < 3; ++axis)
      groups.back().fixed |= fixed[range.begin->master][axis] ? 1u << axis : 0u;
  }
  if (patches == nullptr)
    return;
  close_patches(patches->patches.size() + 1);
  grouped.assign(device_node.size() / 32 + 1, 0);
  const auto mark = [&](std::uint32_t node) { grouped[node / 32] |= 1u << (node & 31u); };
  for (const AttachedGroup& group : groups)
    mark(group.master);
  for (const AttachedTie& tie : ties)
    mark(tie.node);
}

void AttachedTables::add_group(const Model& model, const std::vector<double>& mass,
                               const std::vector<std::uint32_t>& device_node, const AttachedNode* begin,
                               const AttachedNode* end)
{
  const std::int32_t master = begin->master;
  AttachedGroup& group = groups.emplace_back();
  put(rest_point(model, master), group.rest);
  group.mass = static_cast<float>(mass[master]);
  group.master = device_node[master];
  group.first = static_cast<std::int32_t>(ties.size());
  for (const AttachedNode* node = begin; node != end; ++node)
  {
    AttachedTie tie{};
    put(rest_point(model, node->node), tie.rest);
    tie.ratio = static_cast<float>(node->ratio);
    tie.mass = static_cast<float>(mass[node->node]);
    tie.node = device_node[node->node];
    tie.bone = node->bone;
    tie.plane = tie.master_plane = -1;
    if (node->surface >= 0)
    {
      tie.bone = model.constraint_surfaces[node->surface].bone;
      tie.offset = static_cast<float>(level_offset(model, *node));
      // one per tie, because the threads of a group take its ties at the same time
      tie.master_plane = add_place(model, master, node->surface);
      tie.plane = add_place(model, node->node, node->surface);
    }
    group.fixed |= tie.bone >= 0 ? on_bones : 0;
    ties.push_back(tie);
  }
  group.last = static_cast<std::int32_t>(ties.size());
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
    : groups_(tables.groups),
      ties_(tables.ties),
      places_(tables.places),
      planes_(tables.places.size()),
      patches_(tables.patch_groups),
      grouped_(tables.grouped)
{
  reset();
}

void DeviceAttachment::take_masses(const float4* u, cudaStream_t stream) const
{
  if (!empty())
    require(launch_take_masses(u, groups_.data(), static_cast<std::uint32_t>(groups_.size()), ties_.data(),
                               static_cast<std::uint32_t>(ties_.size()), stream),
            "setting masses of attached nodes");
}

void DeviceAttachment::describe(StepArguments& g) const
{
  g.attached = { groups_.data(), static_cast<std::uint32_t>(groups_.size()),
                 ties_.data(),   places_.data(),
                 planes_.data(), patches_.data(),
                 grouped_.data() };
}

void DeviceAttachment::list_arrays(ArrayList& list)
{
  list.add(Effect::attachment, "attached nodes",
           groups_.bytes() + ties_.bytes() + places_.bytes() + patches_.bytes() + grouped_.bytes());
  list_state(list, Effect::attachment, "tangent planes", planes_);
}

}  // namespace cuda
}  // namespace frontalis
