#include "cuda/backend/device_body_contact.hpp"
#include "cuda/backend/device_shell.hpp"
#include "cuda/backend/device_tissue_contact.hpp"

#include <algorithm>

namespace frontalis
{
namespace cuda
{

static_assert(effect_traits.size() == 16,
              "a new effect needs a DevicePart, or CudaSolver has to refuse models that have the effect");

bool need_strips(const Model& model)
{
  return std::any_of(model.contacts.begin(), model.contacts.end(),
                     [](const Contact& contact) { return contact.mass > 0; });
}

std::vector<std::unique_ptr<DevicePart>> device_parts(const Model& model, const Discretisation& discretisation,
                                                      const VoxelCut& cut,
                                                      const std::vector<std::uint32_t>& device_node)
{
  std::vector<std::unique_ptr<DevicePart>> parts;
  if (!model.contacts.empty())
    parts.push_back(std::make_unique<DeviceBodyContact>(model, discretisation, cut, device_node));
  if (!model.shells.empty())
    parts.push_back(std::make_unique<DeviceShell>(model, cut, device_node));
  if (!model.self_contacts.empty())
    parts.push_back(std::make_unique<DeviceTissueContact>(model, discretisation, cut, device_node));
  return parts;
}

PartRoom room_for_parts(const Model& model, const VoxelPatches& patches, const std::vector<std::uint32_t>& device_node)
{
  PartRoom all;
  all.room.contact_points = most_touching_points(model, patches);
  // Points of contact have threads of their own as far as possible.
  if (all.room.contact_points > 0)
    all.threads = patches.most_voxels + all.room.contact_points;
  if (!model.shells.empty())
    ShellTables(model, ShellMesh(model), patches, device_node).add_room(patches.most_voxels, all);
  all.room.touch_vertices = most_touching_vertices(model, patches);
  // Pairs have threads of their own as far as possible. A patch has about as many pairs of its own vertices as of those
  // that they face, and a margin.
  if (all.room.touch_vertices > 0)
    all.threads = std::max(all.threads, patches.most_voxels + touch_ahead * all.room.touch_vertices);
  return all;
}

BoundWork bound_work(const Model& model)
{
  // Cost of a point relative to a voxel without effects. It was chosen to minimise the wall time per step of the
  // generated head, and for shells of the generated foreheads.
  constexpr float touch_cost = 2, pair_cost = 4, shell_cost = 2;
  BoundWork work;
  if (!model.contacts.empty() || !model.self_contacts.empty() || !model.shells.empty())
    work.cost.assign(model.voxels.size(), 0);
  for (const Contact& contact : model.contacts)
    for (std::size_t p = 0; p < contact.points.size(); ++p)
      work.cost[contact.binding.voxel[p]] += contact.area[p] > 0 ? touch_cost : 0;
  for (const SelfContact& contact : model.self_contacts)
    for (const std::int32_t voxel : contact.binding.voxel)
      work.cost[voxel] += pair_cost;
  if (!model.shells.empty())
  {
    const ShellMesh mesh(model);
    work.beside = voxels_beside(model, mesh);
    for (const auto voxel : mesh.binding.voxel)
      work.cost[voxel] += shell_cost;
  }
  return work;
}

}  // namespace cuda
}  // namespace frontalis
