#include "cuda/backend/device_model.hpp"

#include <algorithm>

namespace frontalis
{
namespace cuda
{

// Switching an effect off keeps its arrays and changes their entries, which then say, for instance, that strips have no
// fibres or nodes have no tasks.

std::vector<std::uint32_t> muscle_words(const Model& model, EffectSet running)
{
  std::vector<std::uint32_t> words;
  const bool passive = running.has(Effect::fibre_stiffness);
  for (const auto m : model.fibre_muscle)
  {
    const Muscle& muscle = model.muscles[m];
    words.push_back(static_cast<std::uint32_t>(m) | (muscle.tension_length ? 0x40000000u : 0) |
                    (muscle.passive && passive ? 0x80000000u : 0));
  }
  return words;
}

void DeviceModel::run(const Model& model, const Discretisation& discretisation, EffectSet running)
{
  if (whole_.strips.empty() && whole_.patch_tasks.empty())
  {
    strips_.download(whole_.strips);
    tasks_.download(whole_.tasks);
    patch_tasks_.download(whole_.patch_tasks);
  }
  for (EffectPart* const part : all_parts())
    part->run(running);
  viscosity_.describe(constants_);
  contacts_.describe(constants_);
  constants_.load_relief = running.has(Effect::gravity) ? loads_.relief() : nullptr;
  run_fibres(model, discretisation, running);
  run_tasks(running);
  choose_effects(running);
}

void DeviceModel::run_fibres(const Model& model, const Discretisation& discretisation, EffectSet running)
{
  if (fibre_muscle_.size() == 0)
    return;
  const auto words = muscle_words(model, running);
  fibre_muscle_.upload(words.data(), words.size());
  const bool any = running.has(Effect::contraction) || running.has(Effect::fibre_stiffness);
  constants_.fibres = any ? fibres_.data() : nullptr;
  auto strips = whole_.strips;
  for (Strip& strip : strips)
    if (!any)
      strip.fibre_begin = Strip::none;
  strips_.upload(strips.data(), strips.size());

  // The stiffness bounds of voxels depend on the running effects.
  std::vector<float> bounds(stiffness_bounds_.size(), 0);
  VoxelProperties voxel;
  for (std::size_t e = 0; e < palette_of_voxel_.size(); ++e)
  {
    discretisation.voxel(e, voxel);
    float& bound = bounds[palette_of_voxel_[e]];
    bound = std::max(bound, static_cast<float>(voxel.stiffness));
  }
  stiffness_bounds_.upload(bounds.data(), bounds.size());
}

void DeviceModel::run_tasks(EffectSet running)
{
  const bool slides = running.has(Effect::sliding);
  auto tasks = whole_.tasks;
  for (NodeTask& task : tasks)
  {
    if (loads_.idle())
      task.of[node_load] = -1;
    if (!slides)
      task.of[node_sliding] = task.of[node_gliding] = -1;
  }
  tasks_.upload(tasks.data(), tasks.size());
  effects_ = voxel_part(effects_) | node_part(tasks);
  auto words = whole_.patch_tasks;
  for (std::int32_t& word : words)
    if (!slides && (word >= 0 || patch_task::is(patch_task::glides, word)))
      word = patch_task::none;
  patch_tasks_.upload(words.data(), words.size());
}

// The flags of `Effects` that the tasks of nodes require.
Effects DeviceModel::node_part(const std::vector<NodeTask>& tasks) const
{
  Effects part = Effects::none;
  for (const NodeTask& task : tasks)
  {
    if (task.of[node_sliding] >= 0 || task.of[node_gliding] >= 0)
      part = part | Effects::sliding;
    const bool any = std::any_of(std::begin(task.of), std::end(task.of), [](std::int32_t index) { return index >= 0; });
    if (any && !(launch_.patches && has_only(task, node_sliding)))
      part = part | Effects::tasks;
  }
  return part;
}

// Chooses the kernel that computes the running effects and as few others as possible, for the number of rows of the
// strips.
void DeviceModel::choose_effects(EffectSet running)
{
  Effects least = most_effects_ & (Effects::general_element | Effects::cut);
  const bool laws = !launch_.patches && laws_.size() > 0;
  if (running.has(Effect::contraction) || running.has(Effect::fibre_stiffness) || laws)
    least = least | (most_effects_ & (Effects::fibres | Effects::added));
  if (running.has(Effect::viscosity))
    least = least | (most_effects_ & Effects::viscosity);
  if (!launch_.patches && strip_rows(least) != strip_rows(most_effects_))
    least = least | (most_effects_ & (Effects::fibres | Effects::viscosity | Effects::added));
  effects_ = least | (effects_ & (Effects::sliding | Effects::tasks));
  if (running.has(Effect::sliding) && running.has(Effect::friction))
    effects_ = effects_ | (most_effects_ & Effects::friction);
  choose_kernel();
}

StepLaunch DeviceModel::launch_with_parts() const
{
  StepLaunch launch = launch_;
  for (const auto& part : parts_)
    if (launch.patches)
      launch.effects = launch.effects | part->effects();
  return launch;
}

void DeviceModel::choose_kernel()
{
  launch_.effects = effects_;
  if (launch_.patches && (!attachment_.empty() || (effects_ & Effects::cut) == Effects::cut))
    launch_.effects = launch_.effects | of_nodes | Effects::cut | Effects::groups;
  for (const DevicePart* const part : running_parts())
    if (launch_.patches)
      launch_.effects = launch_.effects | part->effects();
}

std::vector<DevicePart*> DeviceModel::running_parts() const
{
  std::vector<DevicePart*> running;
  for (const auto& part : parts_)
    if (!part->idle())
      running.push_back(part.get());
  return running;
}

std::vector<EffectPart*> DeviceModel::all_parts()
{
  std::vector<EffectPart*> all{ &loads_, &viscosity_, &contacts_, &attachment_ };
  for (const auto& part : parts_)
    all.push_back(part.get());
  return all;
}

void DeviceModel::list_arrays(Effect of_fibres, ArrayList& list)
{
  const auto add = [&list](Effect effect, const char* what, const auto&... arrays)
  { (list.add(effect, what, arrays.bytes()), ...); };
  add(Effect::elasticity, "strips", strips_, slots_);
  add(Effect::elasticity, "patches", patches_, patch_corners_, node_voxels_, patch_properties_, halo_);
  add(Effect::elasticity, "inverse masses", mobility_, limited_mobility_);
  list.add_state(limited_mobility_.data(), limited_mobility_.bytes());
  add(Effect::elasticity, "palette", palette_, stiffness_bounds_, stabilisation_, law_begin_, laws_);
  add(Effect::elasticity, "added stress", added_voxels_, added_stress_);
  add(Effect::cut_voxels, "centroids of tissue", centres_, corner_stiffness_);
  add(of_fibres, "fibres", fibre_words_, fibre_muscle_, fibres_);
  add(Effect::rigid_nodes, "poses", rigid_);
  add(Effect::prescribed_displacement, "prescribed nodes", prescribed_);
  add(Effect::elasticity, "what nodes do", tasks_, patch_tasks_);
  for (EffectPart* const part : all_parts())
    part->list_arrays(list);
}

void DeviceModel::reset()
{
  if (limited_mobility_.size() > 0)
    require(cudaMemcpy(limited_mobility_.data(), mobility_.data(), mobility_.bytes(), cudaMemcpyDeviceToDevice),
            "copying on the device");
  for (EffectPart* const part : all_parts())
    part->reset();
}

}  // namespace cuda
}  // namespace frontalis
