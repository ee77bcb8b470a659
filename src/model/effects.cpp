#include "model/effect_description.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace frontalis
{
namespace
{

std::string counted(std::size_t count, const std::string& one)
{
  return fmt::format("{} {}{}", count, one, count == 1 ? "" : "s");
}

bool is_off(const Model& model, Effect effect)
{
  const auto& off = model.switched_off;
  return std::find(off.begin(), off.end(), name_of(effect)) != off.end();
}

// Number of voxels with fibres; with `passive_alone`, only fibres of muscles that have passive stress count.
std::size_t voxels_with_fibres(const Model& model, bool passive_alone)
{
  std::size_t count = 0;
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
    count += std::any_of(model.fibre_muscle.begin() + model.fibre_begin[e],
                         model.fibre_muscle.begin() + model.fibre_begin[e + 1],
                         [&](auto m) { return !passive_alone || model.muscles[m].passive; })
                 ? 1
                 : 0;
  return count;
}

bool is_viscous(const Material& material) { return material.viscous_share[0] > 0 || material.viscous_share[1] > 0; }

std::size_t viscous_voxels(const Model& model)
{
  std::size_t count = 0;
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
    count += is_viscous(model, e) ? 1 : 0;
  return count;
}

bool is_surface_load(const Load& load) { return load.kind != Load::Kind::displacement; }

std::size_t loaded_nodes(const Model& model)
{
  std::vector<bool> loaded(model.nodes.size(), false);
  for (const Load& load : model.loads)
    if (is_surface_load(load))
      for (const auto voxel : load.binding.voxel)
        for (const auto node : model.voxel_nodes[voxel])
          loaded[node] = true;
  return static_cast<std::size_t>(std::count(loaded.begin(), loaded.end(), true));
}

template <class Entry>
std::size_t distinct_nodes(const std::vector<Entry>& entries)
{
  std::vector<std::int32_t> nodes;
  nodes.reserve(entries.size());
  for (const Entry& entry : entries)
    nodes.push_back(entry.node);
  std::sort(nodes.begin(), nodes.end());
  return static_cast<std::size_t>(std::unique(nodes.begin(), nodes.end()) - nodes.begin());
}

std::size_t count_passive(const Model& model)
{
  return static_cast<std::size_t>(
      std::count_if(model.muscles.begin(), model.muscles.end(), [](const Muscle& m) { return m.passive; }));
}

std::size_t count_surface_loads(const Model& model)
{
  return static_cast<std::size_t>(std::count_if(model.loads.begin(), model.loads.end(), is_surface_load));
}

EffectPresence on_voxels(std::size_t voxels, const std::string& why, const std::string& otherwise)
{
  return { voxels > 0, voxels > 0 ? why : otherwise, voxels, 0 };
}

EffectPresence on_nodes(std::size_t nodes, const std::string& why, const std::string& otherwise)
{
  return { nodes > 0, nodes > 0 ? why : otherwise, 0, nodes };
}

void remove_fibres(Model& model, bool keep_passive)
{
  std::vector<std::int32_t> begin(1, 0);
  std::size_t kept = 0;
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
  {
    for (auto f = model.fibre_begin[e]; f < model.fibre_begin[e + 1]; ++f)
      if (keep_passive && model.muscles[model.fibre_muscle[f]].passive)
      {
        model.fibre_muscle[kept] = model.fibre_muscle[f];
        model.fibre_weight[kept] = model.fibre_weight[f];
        model.fibre_direction[kept++] = model.fibre_direction[f];
      }
    begin.push_back(static_cast<std::int32_t>(kept));
  }
  model.fibre_begin = begin;
  model.fibre_muscle.resize(kept);
  model.fibre_weight.resize(kept);
  model.fibre_direction.resize(kept);
}

// Removes the loads for which the condition holds, and the prescribed nodes that follow them.
template <class Condition>
void remove_loads(Model& model, Condition&& goes)
{
  std::vector<std::int32_t> index;
  std::vector<Load> loads;
  for (Load& load : model.loads)
  {
    index.push_back(goes(load) ? -1 : static_cast<std::int32_t>(loads.size()));
    if (index.back() >= 0)
      loads.push_back(std::move(load));
  }
  std::vector<PrescribedNode> prescribed;
  for (const PrescribedNode& node : model.prescribed)
    if (index[node.load] >= 0)
      prescribed.push_back({ node.node, index[node.load] });
  model.loads = std::move(loads);
  model.prescribed = std::move(prescribed);
}

EffectDescription elasticity()
{
  return { Effect::elasticity,
           [](const Model& model) { return on_voxels(model.voxels.size(), "always", "no voxel"); } };
}

EffectDescription fibre_stiffness()
{
  return { Effect::fibre_stiffness,
           [](const Model& model)
           {
             return on_voxels(voxels_with_fibres(model, true),
                              counted(count_passive(model), "muscle") + " with passive fibres",
                              "no muscle has passive fibres");
           },
           [](Model& model, EffectSet)
           {
             for (Muscle& muscle : model.muscles)
               muscle.passive = false;
           } };
}

EffectDescription contraction()
{
  return { Effect::contraction,
           [](const Model& model) {
             return on_voxels(voxels_with_fibres(model, false), counted(model.muscles.size(), "muscle"), "no muscles");
           },
           [](Model& model, EffectSet off) { remove_fibres(model, !off.has(Effect::fibre_stiffness)); } };
}

EffectDescription viscosity()
{
  return { Effect::viscosity,
           [](const Model& model)
           { return on_voxels(viscous_voxels(model), "materials with a Prony series", "no material is viscous"); },
           [](Model& model, EffectSet)
           {
             for (Material& material : model.materials)
               material.viscous_share = material.viscous_time = {};
           } };
}

EffectDescription gravity()
{
  return { Effect::gravity,
           [](const Model& model)
           {
             const bool any = std::any_of(model.gravity.begin(), model.gravity.end(), [](double g) { return g != 0; });
             return on_nodes(any ? model.nodes.size() : 0, "the scene gives an acceleration", "no acceleration given");
           },
           [](Model& model, EffectSet) { model.gravity = {}; } };
}

EffectDescription surface_loads()
{
  return { Effect::surface_loads,
           [](const Model& model) {
             return on_nodes(loaded_nodes(model), counted(count_surface_loads(model), "load"),
                             "no traction or pressure");
           },
           [](Model& model, EffectSet) { remove_loads(model, is_surface_load); } };
}

EffectDescription prescribed_displacement()
{
  return { Effect::prescribed_displacement,
           [](const Model& model)
           {
             return on_nodes(distinct_nodes(model.prescribed),
                             counted(model.loads.size() - count_surface_loads(model), "path"), "no node has a path");
           },
           [](Model& model, EffectSet)
           { remove_loads(model, [](const Load& load) { return !is_surface_load(load); }); } };
}

EffectDescription rigid_nodes()
{
  EffectDescription rigid{ Effect::rigid_nodes,
                           [](const Model& model) {
                             return on_nodes(distinct_nodes(model.rigid), "nodes at rigid surfaces", "nothing is held");
                           },
                           [](Model& model, EffectSet)
                           {
                             model.rigid.clear();
                             remove_attached(model, false);
                           } };
  rigid.set_bones = [](const Model& model, std::vector<std::int32_t>& bone)
  {
    for (const RigidNode& node : model.rigid)
      bone[node.node] = node.bone;
  };
  return rigid;
}

EffectDescription sliding()
{
  EffectDescription sliding{ Effect::sliding,
                             [](const Model& model)
                             {
                               return on_nodes(distinct_nodes(model.sliding),
                                               counted(model.constraint_surfaces.size(), "surface"),
                                               "no surface to slide on");
                             },
                             [](Model& model, EffectSet)
                             {
                               model.sliding.clear();
                               remove_attached(model, true);
                               model.constraint_surfaces.clear();
                             } };
  sliding.set_bones = [](const Model& model, std::vector<std::int32_t>& bone)
  {
    for (const SlidingNode& node : model.sliding)
      bone[node.node] = model.constraint_surfaces[node.surface].bone;
  };
  return sliding;
}

EffectDescription friction()
{
  return { Effect::friction,
           [](const Model& model)
           {
             const auto rough = [&](const SlidingNode& node)
             { return model.constraint_surfaces[node.surface].friction > 0; };
             return on_nodes(static_cast<std::size_t>(std::count_if(model.sliding.begin(), model.sliding.end(), rough)),
                             "surfaces with friction", "no surface has friction");
           },
           [](Model& model, EffectSet)
           {
             for (ConstraintSurface& surface : model.constraint_surfaces)
               surface.friction = 0;
           } };
}

EffectDescription output_fields()
{
  return { Effect::output_fields, [](const Model& model) -> EffectPresence {
            return { !model.skin.vertices.empty(), model.skin.vertices.empty() ? "no skin" : "on request", 0, 0 };
          } };
}

// The entries are in the order of the enumeration Effect.
const std::array<EffectDescription, effect_traits.size()> descriptions{
  { elasticity(), fibre_stiffness(), contraction(), viscosity(), gravity(), surface_loads(), prescribed_displacement(),
    rigid_nodes(), sliding(), friction(), contact_description(), self_contact_description(), attachment_description(),
    shell_description(), cut_voxels_description(), output_fields() }
};

const EffectDescription& description_of(Effect effect) { return descriptions[static_cast<std::size_t>(effect)]; }

}  // namespace

bool is_viscous(const Model& model, std::size_t voxel)
{
  bool viscous = false;
  for (auto m = model.mixture_begin[voxel]; m < model.mixture_begin[voxel + 1]; ++m)
    viscous = viscous || (model.mixture_proportion[m] > 0 && is_viscous(model.materials[model.mixture_material[m]]));
  return viscous;
}

bool has_law(const Model& model, std::size_t voxel)
{
  bool any = false;
  for (auto m = model.mixture_begin[voxel]; m < model.mixture_begin[voxel + 1]; ++m)
    any =
        any || (model.mixture_proportion[m] > 0 && model.materials[model.mixture_material[m]].law != Law::neo_hookean);
  return any;
}

EffectPresence presence_of(const Model& model, Effect effect)
{
  if (is_off(model, effect))
    return { false, "switched off by the scene", 0, 0 };
  return description_of(effect).found(model);
}

EffectSet effects_of(const Model& model)
{
  EffectSet set;
  for (const Effect effect : every_effect())
    if (presence_of(model, effect).present)
      set = set.with(effect);
  return set;
}

void switch_off(Model& model, EffectSet off)
{
  check_switched_off(off, effects_of(model));
  for (const Effect effect : every_effect())
    if (const auto remove = description_of(effect).remove; off.has(effect) && remove != nullptr)
      remove(model, off);
  for (const Effect effect : every_effect())
    if (off.has(effect) && !is_off(model, effect))
      model.switched_off.push_back(name_of(effect));
}

std::vector<TouchedBody> touched_bodies(const Model& model)
{
  std::vector<TouchedBody> bodies;
  for (const EffectDescription& effect : descriptions)
    if (effect.add_bodies != nullptr)
      effect.add_bodies(model, bodies);
  return bodies;
}

std::string restricted_nodes_text(const Model& model, std::int32_t constraint)
{
  const auto count = [constraint](const auto& nodes)
  {
    return std::count_if(nodes.begin(), nodes.end(),
                         [&](const auto& node) { return constraint < 0 || node.constraint == constraint; });
  };
  const auto attached = count(model.attached);
  return fmt::format("rigid {}, sliding {}{}", count(model.rigid), count(model.sliding),
                     attached > 0 ? fmt::format(", attached {}", attached) : "");
}

std::vector<std::int32_t> moving_bones(const Model& model)
{
  std::vector<std::int32_t> bone(model.nodes.size(), -1);
  // Effects are visited in reverse order, because effects that restrict a node override effects that only touch it.
  for (auto effect = descriptions.rbegin(); effect != descriptions.rend(); ++effect)
    if (effect->set_bones != nullptr)
      effect->set_bones(model, bone);
  return bone;
}

void exchange_effects(ModelWriter& archive, const Model& model)
{
  for (const EffectDescription& effect : descriptions)
    if (effect.write != nullptr)
      effect.write(archive, model);
}

void exchange_effects(ModelReader& archive, Model& model)
{
  for (const EffectDescription& effect : descriptions)
    if (effect.read != nullptr)
      effect.read(archive, model);
}

void check_effects(const Model& model)
{
  for (const EffectDescription& effect : descriptions)
    if (effect.check != nullptr)
      effect.check(model);
}

}  // namespace frontalis
