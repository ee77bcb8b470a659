#include "cuda/backend/device_model.hpp"

#include "frontalis/solver/backend.hpp"
#include "solver/stepping/highest_frequency_search.hpp"
#include "solver/stepping/step_bound.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <unordered_map>

namespace frontalis
{
namespace cuda
{
namespace
{

using Entry = std::vector<float>;

struct HashEntry
{
  std::size_t operator()(const Entry& entry) const
  {
    std::size_t hash = 1469598103934665603u;
    for (const float x : entry)
    {
      std::uint32_t bits = 0;
      std::memcpy(&bits, &x, sizeof bits);
      hash = (hash ^ bits) * 1099511628211u;
    }
    return hash ^ (hash >> 29);
  }
};

// The voxels whose stress a kernel computes before each step: those with fibres or with laws other than neo-Hookean,
// unless the laws are computed at Gauss points.
std::vector<std::uint32_t> added_voxels(const Model& model, const Discretisation& discretisation, const VoxelCut& cut)
{
  std::vector<std::uint32_t> voxels;
  for (std::uint32_t e = 0; cut.stress_apart && e < model.voxels.size(); ++e)
  {
    const bool fibres = !model.fibre_muscle.empty() && model.fibre_begin[e] < model.fibre_begin[e + std::size_t{ 1 }];
    if (fibres || (!discretisation.selective_reduced && has_law(model, e)))
      voxels.push_back(e);
  }
  return voxels;
}

// Throws BackendUnavailable if the largest arrays (nodes, patches or strips, fibres, added voxels) exceed the free
// memory.
void expect_room(const Model& model, const Discretisation& discretisation, const VoxelCut& cut)
{
  const bool searches = model.time_step_estimate == TimeStepEstimate::assembled;
  const std::size_t vectors = model.mass_scaling.in_motion > 0 ? most_lanczos_iterations : 2;
  const std::size_t node_bytes = (2 + (searches ? 4 + vectors : 0)) * sizeof(float4) + 3 * sizeof(float);
  std::size_t wanted =
      (model.nodes.size() + 1) * node_bytes + model.fibre_muscle.size() * (sizeof(float4) + sizeof(std::uint32_t));
  if (cut.patches)
    wanted += cut.patches->voxel.size() * (sizeof(uint4) + sizeof(uint2)) +
              cut.patches->halo.size() * sizeof(std::uint32_t) +
              model.nodes.size() * (sizeof(uint4) + sizeof(std::int32_t));
  else
    wanted += cut.strips->slots.size() * sizeof(StripSlot) + cut.strips->fibre_words.size() * sizeof(std::uint32_t);
  wanted += added_voxels(model, discretisation, cut).size() *
            (sizeof(AddedVoxel) + sizeof(AddedStress) + sizeof(float4) + sizeof(LawEntry));
  std::size_t free = 0, total = 0;
  require(cudaMemGetInfo(&free, &total), "asking for free memory");
  if (wanted > free)
    throw BackendUnavailable(
        fmt::format("backend cuda: the model needs {} bytes of device memory, {} of {} are free", wanted, free, total));
}

}  // namespace

Effects effects_of(const Model& model, const Discretisation& discretisation, bool in_strips)
{
  Effects effects = Effects::none;
  if (discretisation.assumed_strain || discretisation.selective_reduced || (discretisation.laws && !in_strips))
    effects = effects | Effects::general_element;
  if (discretisation.viscous_terms > 0)
    effects = effects | Effects::viscosity;
  if (!discretisation.corner_stiffness.empty())
    effects = effects | Effects::cut;
  if (!model.fibre_muscle.empty() || (discretisation.laws && in_strips))
    effects = effects | Effects::fibres;
  for (const SlidingNode& node : model.sliding)
    if (model.constraint_surfaces[node.surface].friction > 0)
      effects = effects | Effects::friction;
  return effects;
}

DeviceModel::DeviceModel(const Model& model, const Discretisation& discretisation, const CutChoice& cut)
    : DeviceModel(model, discretisation, VoxelCut(model, cut))
{
}

DeviceModel::DeviceModel(const Model& model, const Discretisation& discretisation, VoxelCut&& cut)
    : most_effects_(effects_of(model, discretisation, cut.strips != nullptr)),
      device_node_((expect_room(model, discretisation, cut), std::move(cut.device_node()))),
      loads_(model, discretisation, device_node_),
      viscosity_(model, discretisation, device_node_,
                 discretisation.viscous_terms > 0 ? cut.voxel_at() : std::vector<std::uint32_t>(),
                 cut.patches != nullptr),
      contacts_(model, device_node_),
      attachment_(model, discretisation.node_mass, device_node_, cut.patches.get())
{
  const std::vector<std::uint32_t> added = added_voxels(model, discretisation, cut);
  if (!added.empty())
    most_effects_ =
        (most_effects_ & (Effects::viscosity | Effects::general_element | Effects::friction | Effects::cut)) |
        Effects::added;
  palette_of_voxel_ = add_palette(model, discretisation, added);
  add_added_voxels(model, added);
  add_fibres(model, discretisation);
  std::vector<NodeTask> tasks = add_tasks(model);
  // Nodes that never move have the inverse mass 0 in any case. If other nodes are held as well, or nodes are attached,
  // the frequency bound needs inverse masses of its own. So does the measure of growth.
  const bool assembled = model.time_step_estimate == TimeStepEstimate::assembled;
  if (assembled || discretisation.held.size() > still_nodes_.size() || !discretisation.bound_mass.empty())
  {
    const std::vector<float> of_node = mobility(discretisation);
    std::vector<float> of_device(nodes(), 0);
    for (std::size_t n = 0; n < of_node.size(); ++n)
      of_device[device_node_[n]] = of_node[n];
    mobility_ = DeviceArray<float>(of_device);
    if (assembled)
      limited_mobility_ = DeviceArray<float>(of_device);
  }
  parts_ = device_parts(model, discretisation, cut, device_node_);
  if (cut.patches)
    add_patches(model, *cut.patches, cut.part_room, tasks, palette_of_voxel_);
  else
    add_strips(*cut.strips);
  most_effects_ = most_effects_ | node_part(tasks);
  effects_ = most_effects_;
  choose_kernel();
  tasks_ = DeviceArray<NodeTask>(tasks);

  StepArguments& g = constants_;
  g.patches = patches_.data();
  g.patch_count = static_cast<std::uint32_t>(patches_.size());
  g.patch_corners = patch_corners_.data();
  g.patch_properties = patch_properties_.data();
  g.halo = halo_.data();
  g.node_voxels = node_voxels_.data();
  g.patch_tasks = patch_tasks_.data();
  g.strips = strips_.data();
  static_assert(sizeof(StripSlot) == sizeof(uint2), "a slot is read as two words");
  g.slots = reinterpret_cast<const uint2*>(slots_.data());
  g.strip_count = static_cast<std::uint32_t>(strips_.size());
  g.mobility = assembled ? limited_mobility_.data() : mobility_.data();
  g.palette = palette_.data();
  g.stiffness_bounds = stiffness_bounds_.data();
  g.stabilisation = stabilisation_.data();
  g.centres = centres_.data();
  g.corner_stiffness = corner_stiffness_.data();
  g.law_begin = law_begin_.data();
  g.laws = laws_.data();
  g.added_voxels = added_voxels_.data();
  g.added_stress = added_stress_.data();
  g.added_count = static_cast<std::uint32_t>(added_voxels_.size());
  g.muscles = static_cast<std::int32_t>(model.muscles.size());
  g.fibre_words = fibre_words_.data();
  g.fibres = fibres_.data();
  g.fibre_muscle = fibre_muscle_.data();
  g.tasks = tasks_.data();
  g.task_count = static_cast<std::uint32_t>(tasks_.size());
  g.load_parts = loads_.parts();
  g.load_begin = loads_.begin();
  g.surface_force = loads_.surface_force();
  g.load_growth = loads_.growth();
  g.load_relief = loads_.relief();
  g.selective_reduced = discretisation.selective_reduced;
  viscosity_.describe(g);
  contacts_.describe(g);
  attachment_.describe(g);
  g.prescribed = prescribed_.data();
  g.rigid = rigid_.data();
  g.bones = static_cast<std::int32_t>(model.bones.size());
  g.stretch_half_sum = static_cast<float>(discretisation.stretch_half_sum);
  const auto& h = model.spacing;
  for (int axis = 0; axis < 3; ++axis)
  {
    g.scale[axis] = static_cast<float>(0.25 / h[axis]);
    g.stretch_weight[axis] = static_cast<float>(discretisation.stretch_weight[axis]);
    g.hourglass_weight[axis] = static_cast<float>(discretisation.hourglass_weight[axis]);
  }
}

StepArguments DeviceModel::arguments(bool idle_parts) const
{
  StepArguments g = constants_;
  for (const auto& part : parts_)
    if (idle_parts || !part->idle())
      part->describe(g);
  return g;
}

// Voxels with equal properties share a palette entry; entry 0 has no stiffness. The first voxels, `added`, have entries
// of their own, so that the entry is also the place of their added stress. Returns the entry of each voxel.
std::vector<std::uint32_t> DeviceModel::add_palette(const Model& model, const Discretisation& d,
                                                    const std::vector<std::uint32_t>& added)
{
  const bool stabilised = d.assumed_strain, cut = !d.corner_stiffness.empty();
  std::vector<float4> entries(1, float4{ 0, 0, 0, 0 });
  std::vector<float> bounds(1, 0);
  std::vector<float4> more(stabilised ? 1 : 0, float4{ 0, 0, 0, 0 });
  std::vector<float4> centres(cut ? 1 : 0, float4{ 0, 0, 0, 0 });
  std::vector<float4> corners(cut ? 2 : 0, float4{ 0, 0, 0, 0 });
  std::vector<std::uint32_t> law_begin(2, 0);
  std::vector<LawEntry> laws;
  std::vector<std::uint32_t> entry_of(model.voxels.size());
  std::unordered_map<Entry, std::uint32_t, HashEntry> known;
  Entry latest, entry;
  std::uint32_t index = 0;
  VoxelProperties voxel;
  std::vector<std::uint32_t> order = added;
  std::vector<char> is_added(model.voxels.size(), 0);
  for (const std::uint32_t e : added)
    is_added[e] = 1;
  for (std::uint32_t e = 0; e < model.voxels.size(); ++e)
    if (is_added[e] == 0)
      order.push_back(e);
  for (const std::uint32_t e : order)
  {
    d.voxel(e, voxel);
    entry.clear();
    for (const double x : { voxel.mu * voxel.tissue_volume, voxel.kappa * voxel.tissue_volume, voxel.hourglass,
                            voxel.stiffening, voxel.stiffness })
      entry.push_back(static_cast<float>(x));
    const auto& form = voxel.stabilisation;
    if (stabilised)
      for (const double x : { form.bending, form.coupling, form.torsion, form.warping })
        entry.push_back(static_cast<float>(x));
    if (cut)
    {
      for (const double x : { voxel.centre.x, voxel.centre.y, voxel.centre.z })
        entry.push_back(static_cast<float>(x));
      const auto& factors = d.corner_stiffness[e];
      entry.insert(entry.end(), factors.begin(), factors.end());
    }
    for (const LawPart& part : voxel.laws)
    {
      for (const double x : { static_cast<double>(part.law), part.weight * voxel.tissue_volume, part.per_tangent,
                              part.stiffness_at_rest })
        entry.push_back(static_cast<float>(x));
      for (const double x : part.parameters)
        entry.push_back(static_cast<float>(x));
    }
    if (is_added[e] != 0 || index == 0 || entry != latest)
    {
      index = static_cast<std::uint32_t>(entries.size());
      const auto found = is_added[e] != 0 ? known.end() : known.emplace(entry, index).first;
      if (found != known.end())
        index = found->second;
      if (index == entries.size())
      {
        entries.push_back(float4{ entry[0], entry[1], entry[2], entry[3] });
        bounds.push_back(entry[4]);
        std::size_t at = 5;
        if (stabilised)
        {
          more.push_back(float4{ entry[5], entry[6], entry[7], entry[8] });
          at = 9;
        }
        if (cut)
        {
          const float* const from = entry.data() + at;
          centres.push_back(float4{ from[0], from[1], from[2], 0 });
          corners.push_back(float4{ from[3], from[4], from[5], from[6] });
          corners.push_back(float4{ from[7], from[8], from[9], from[10] });
          at += 11;
        }
        for (; at < entry.size(); at += 15)
        {
          LawEntry law{ static_cast<std::int32_t>(entry[at]), entry[at + 1], entry[at + 2], entry[at + 3], {} };
          std::copy(entry.begin() + static_cast<std::ptrdiff_t>(at) + 4,
                    entry.begin() + static_cast<std::ptrdiff_t>(at) + 15, law.parameters);
          laws.push_back(law);
        }
        law_begin.push_back(static_cast<std::uint32_t>(laws.size()));
      }
      latest = entry;
    }
    entry_of[e] = index;
    // An added voxel does not share its entry, so the next voxel must not take this one.
    index = is_added[e] != 0 ? 0 : index;
  }
  viscosity_.set_palette(entry_of);
  palette_ = DeviceArray<float4>(entries);
  stiffness_bounds_ = DeviceArray<float>(bounds);
  stabilisation_ = DeviceArray<float4>(more);
  centres_ = DeviceArray<float4>(centres);
  corner_stiffness_ = DeviceArray<float4>(corners);
  if (!laws.empty())
  {
    law_begin_ = DeviceArray<std::uint32_t>(law_begin);
    laws_ = DeviceArray<LawEntry>(laws);
  }
  return entry_of;
}

void DeviceModel::add_added_voxels(const Model& model, const std::vector<std::uint32_t>& added)
{
  std::vector<AddedVoxel> voxels;
  for (const std::uint32_t e : added)
  {
    AddedVoxel voxel{ {}, fibre_word(model, e) };
    for (int b = 0; b < 8; ++b)
      voxel.node[b] = device_node_[model.voxel_nodes[e][b]];
    voxels.push_back(voxel);
  }
  added_voxels_ = DeviceArray<AddedVoxel>(voxels);
  added_stress_ = DeviceArray<AddedStress>(voxels.size());
}

void DeviceModel::add_fibres(const Model& model, const Discretisation& discretisation)
{
  std::vector<float4> fibres;
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
    for (auto f = model.fibre_begin[e]; f < model.fibre_begin[e + 1]; ++f)
    {
      const Muscle& muscle = model.muscles[model.fibre_muscle[f]];
      const auto& a = model.fibre_direction[f];
      fibres.push_back({ a[0], a[1], a[2],
                         static_cast<float>(muscle.stress_reference * model.fibre_weight[f] * discretisation.volume *
                                            model.fill[e]) });
    }
  fibres_ = DeviceArray<float4>(fibres);
  fibre_muscle_ = DeviceArray<std::uint32_t>(muscle_words(model, EffectSet::all()));
}

// Lists the loads and restrictions of nodes. Nodes that never move have no tasks. Tasks are sorted by the kinds of
// their effects, so that the threads of a warp do the same, and then by device node.
std::vector<NodeTask> DeviceModel::add_tasks(const Model& model)
{
  std::vector<NodeTask> task_of(model.nodes.size(), NodeTask{ 0, { -1, -1, -1, -1, -1 } });
  contacts_.add_tasks(task_of);
  for (std::size_t l = 0; l < loads_.nodes().size(); ++l)
    task_of[loads_.nodes()[l]].of[node_load] = static_cast<std::int32_t>(l);
  std::vector<PrescribedMotion> prescribed;
  for (const auto& node : model.prescribed)
  {
    std::int32_t& index = task_of[node.node].of[node_prescribed];
    if (index < 0)
    {
      index = static_cast<std::int32_t>(prescribed.size());
      prescribed.push_back({});
    }
    const Load& load = model.loads[node.load];
    for (int axis = 0; axis < 3; ++axis)
      if (load.fixed[axis])
      {
        prescribed[index].fixed[axis] = true;
        prescribed[index].value[axis] = load.value[axis];
        prescribed[index].ramp[axis] = load.ramp;
      }
  }
  std::vector<float4> rigid;
  std::vector<char> still(model.nodes.size(), 0);
  for (const auto& node : model.rigid)
  {
    still[node.node] = node.bone < 0;
    task_of[node.node].of[node_rigid] = node.bone < 0 ? -1 : static_cast<std::int32_t>(rigid.size());
    if (node.bone < 0)
      continue;
    const auto rest = rest_position(model, node.node);
    rigid.push_back({ static_cast<float>(rest[0]), static_cast<float>(rest[1]), static_cast<float>(rest[2]), 0 });
    std::memcpy(&rigid.back().w, &node.bone, sizeof node.bone);
  }

  std::vector<NodeTask> tasks;
  for (std::size_t n = 0; n < model.nodes.size(); ++n)
  {
    NodeTask& t = task_of[n];
    t.node = device_node_[n];
    if (still[n] != 0)
      still_nodes_.push_back(static_cast<std::uint32_t>(n));
    else if (std::any_of(std::begin(t.of), std::end(t.of), [](std::int32_t index) { return index >= 0; }))
      tasks.push_back(t);
  }
  const auto key = [](const NodeTask& task)
  {
    std::uint32_t kinds = 0;
    for (int effect = 0; effect < node_effects; ++effect)
      kinds |= task.of[effect] < 0 ? 0 : 1u << effect;
    return std::make_pair(kinds, task.node);
  };
  std::sort(tasks.begin(), tasks.end(), [&](const NodeTask& a, const NodeTask& b) { return key(a) < key(b); });
  prescribed_ = DeviceArray<PrescribedMotion>(prescribed);
  rigid_ = DeviceArray<float4>(rigid);
  return tasks;
}

}  // namespace cuda
}  // namespace frontalis
