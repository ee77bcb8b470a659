#include "cuda/backend/device_model.hpp"
#include "frontalis/solver/backend.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

namespace frontalis
{
namespace cuda
{

VoxelCut::VoxelCut(const Model& model, const CutChoice& choice)
{
  if (model.nodes.size() >= StripSlot::node_mask || model.fibre_muscle.size() >= (1u << 28))
    throw BackendUnavailable(fmt::format("backend cuda: {} nodes and {} fibre entries; allowed are below 2^30 and 2^28",
                                         model.nodes.size(), model.fibre_muscle.size()));
  const auto fits = [&](const VoxelPatches& cut)
  {
    part_room = room_for_parts(model, cut, cut.device_node);
    PatchRoom& room = part_room.room;
    const auto fit = [&](const PatchRoom& wanted)
    { return patch_bytes(cut.most_voxels, cut.most_halo, cut.most_nodes, wanted) <= choice.patch_bytes; };
    PatchRoom with = room;
    with.table_words += part_room.triangle_words;
    with.keeps_triangles = part_room.triangle_words > 0;
    if (fit(with))
      room = with;
    with = room;
    with.group_words = most_group_words(model, cut);
    if (fit(with))
      room = with;
    return cut.fits_indices && part_room.fits_indices && fit(room);
  };
  PatchSettings settings = choice.patches;
  const BoundWork bound = settings.turns > 0 ? bound_work(model) : BoundWork();
  for (; settings.turns > 0 && settings.turns <= most_turns && !patches; ++settings.turns)
    if (auto cut = std::make_unique<VoxelPatches>(model, settings, bound); fits(*cut))
      patches = std::move(cut);
  if (patches)
    return;
  // If fibres fill more than this fraction of the lanes, computing their stress in a kernel of its own costs more than
  // it saves. On an H200 such a kernel made a head faster whose fibres fill 0.28 of the lanes, and a shell slower whose
  // fibres fill 0.48.
  constexpr double dense_fibres = 0.4;
  StripSettings cutting = choice.strips;
  strips = std::make_unique<VoxelStrips>(model, cutting);
  const bool laws = std::any_of(model.materials.begin(), model.materials.end(),
                                [](const Material& material) { return material.law != Law::neo_hookean; });
  stress_apart = laws || strips->filled_by_fibres() < dense_fibres;
  // If the strips compute fibres themselves, those with fibres take longer than the others, and short strips share the
  // work more evenly. Otherwise strips are lengthened until the device can run nearly all of them at the same time. The
  // rest, a tenth, are the shortest ones, which start as the next shortest ones end.
  constexpr double surplus = 1.1;
  while (stress_apart &&
         static_cast<double>(strips->strips.size()) > surplus * static_cast<double>(choice.most_strips) &&
         cutting.planes < choice.most_planes)
  {
    const double wanted = cutting.planes * (static_cast<double>(strips->strips.size()) / choice.most_strips);
    cutting.planes = std::clamp(static_cast<int>(wanted), cutting.planes + 1, choice.most_planes);
    strips = std::make_unique<VoxelStrips>(model, cutting);
  }
}

std::vector<std::uint32_t> VoxelCut::voxel_at() const
{
  std::vector<std::uint32_t> at;
  if (patches)
    for (const auto voxel : patches->voxel)
      at.push_back(1 + voxel);
  else
    for (const auto& slot : strips->slots)
      at.push_back(slot.voxel);
  return at;
}

void DeviceModel::add_strips(VoxelStrips& strips)
{
  filled_ = strips.filled();
  std::vector<char> still(device_node_.size() + 1, 0);
  for (const auto n : still_nodes_)
    still[device_node_[n]] = 1;
  for (auto& slot : strips.slots)
  {
    slot.voxel = slot.voxel > 0 ? palette_of_voxel_[slot.voxel - 1] : 0;
    if (still[slot.node & StripSlot::node_mask] != 0)
      slot.node &= ~StripSlot::updated;
  }
  strips.slots.resize(strips.slots.size() + planes_ahead * static_cast<std::size_t>(strips.rows + 2) * 32,
                      StripSlot{ 0, 0 });
  strips_ = DeviceArray<Strip>(strips.strips);
  slots_ = DeviceArray<StripSlot>(strips.slots);
  // The words are padded, because they are loaded one row ahead.
  if (!strips.fibre_words.empty())
    strips.fibre_words.resize(strips.fibre_words.size() + 32, 0);
  fibre_words_ = DeviceArray<std::uint32_t>(strips.fibre_words);
  launch_.threads = step_block;
}

void DeviceModel::add_patches(const Model& model, const VoxelPatches& patches, const PartRoom& for_parts,
                              const std::vector<NodeTask>& tasks, const std::vector<std::uint32_t>& palette_entry)
{
  std::vector<uint2> properties;
  for (const auto voxel : patches.voxel)
    properties.push_back({ palette_entry[voxel], fibre_word(model, voxel) });
  std::vector<std::int32_t> task_of(device_node_.size() + 1, patch_task::none);
  for (const auto n : still_nodes_)
    task_of[device_node_[n]] = patch_task::still;
  for (std::size_t t = 0; t < tasks.size(); ++t)
  {
    const NodeTask& task = tasks[t];
    if (has_only(task, node_sliding))
      task_of[task.node] = task.of[node_sliding];
    else if (has_only(task, node_gliding))
      task_of[task.node] = patch_task::coded(patch_task::glides, task.of[node_gliding]);
    else if (has_only(task, node_rigid))
      task_of[task.node] = patch_task::coded(patch_task::moves_with_bone, task.of[node_rigid]);
    else
      task_of[task.node] = patch_task::coded(patch_task::other, static_cast<std::int32_t>(t));
  }
  const auto words = [](const std::vector<std::array<std::uint16_t, 8>>& from)
  {
    std::vector<uint4> to(from.size());
    static_assert(sizeof(to[0]) == sizeof(from[0]), "eight places are read as four words");
    std::memcpy(to.data(), from.data(), from.size() * sizeof(to[0]));
    return to;
  };
  patches_ = DeviceArray<Patch>(patches.patches);
  patch_corners_ = DeviceArray<uint4>(words(patches.corner));
  node_voxels_ = DeviceArray<uint4>(words(patches.node_voxel));
  patch_properties_ = DeviceArray<uint2>(properties);
  halo_ = DeviceArray<std::uint32_t>(patches.halo);
  patch_tasks_ = DeviceArray<std::int32_t>(task_of);
  std::uint32_t most = patches.most_voxels;
  for (const Patch& patch : patches.patches)
    most = std::max({ most, patch.nodes, patch.halo });
  launch_.patches = true;
  launch_.room = for_parts.room;
  most = std::max(most, for_parts.threads);
  launch_.threads = static_cast<int>(std::min((most + 31) / 32 * 32, most_patch_threads));
  launch_.most_voxels = patches.most_voxels;
  launch_.most_halo = patches.most_halo;
  launch_.most_nodes = patches.most_nodes;
  launch_.shared_bytes = patch_bytes(patches.most_voxels, patches.most_halo, patches.most_nodes, launch_.room);
}

}  // namespace cuda
}  // namespace frontalis
