#include "bake/voxels/model_stages.hpp"

#include <map>

namespace frontalis
{
namespace
{

/// Finds the first node of a group that has an entry in the map, and gives this entry to all nodes of the group.
/// Returns false if no node has an entry.
template <class Entry>
bool share(const std::vector<std::int32_t>& group, std::map<std::int32_t, Entry>& entries)
{
  const auto has = [&](std::int32_t node) { return entries.count(node) > 0; };
  const auto first = std::find_if(group.begin(), group.end(), has);
  if (first == group.end())
    return false;
  for (const std::int32_t node : group)
  {
    Entry entry = entries.at(*first);
    entry.node = node;
    entries[node] = entry;
  }
  return true;
}

template <class Entry>
std::map<std::int32_t, Entry> by_node(const std::vector<Entry>& list)
{
  std::map<std::int32_t, Entry> entries;
  for (const Entry& entry : list)
    entries[entry.node] = entry;
  return entries;
}

template <class Entry>
void put(const std::map<std::int32_t, Entry>& entries, std::vector<Entry>& list)
{
  list.clear();
  for (const auto& entry : entries)
    list.push_back(entry.second);
}

}  // namespace

void settle_joints(const EffectSet& switched_off, Model& model)
{
  std::map<std::int32_t, std::vector<std::int32_t>> groups;  // nodes joined to each master
  std::map<std::int32_t, std::int32_t> master;
  for (const Model::Joint& joint : model.joints)
  {
    groups[joint.master].push_back(joint.node);
    master[joint.node] = joint.master;
  }
  if (groups.empty())
    return;
  auto rigid = by_node(model.rigid);
  auto sliding = by_node(model.sliding);
  auto attached = by_node(model.attached);
  model.joints.clear();
  for (const auto& [to, nodes] : groups)
  {
    std::vector<std::int32_t> group{ to };
    group.insert(group.end(), nodes.begin(), nodes.end());
    // A restriction that is about to be switched off holds no nodes together.
    if (!switched_off.has(Effect::rigid_nodes) && share(group, rigid))
    {
      for (const std::int32_t node : group)
      {
        sliding.erase(node);
        attached.erase(node);
      }
      continue;
    }
    if (share(group, attached))
    {
      for (const std::int32_t node : group)
        sliding.erase(node);
      continue;
    }
    share(group, sliding);
    for (const std::int32_t node : nodes)
      model.joints.push_back({ node, to });
  }
  for (auto& [node, entry] : attached)
    if (const auto joint = master.find(entry.master); joint != master.end())
      entry.master = joint->second;
  put(rigid, model.rigid);
  put(sliding, model.sliding);
  put(attached, model.attached);
}

}  // namespace frontalis
