// The effects that a model has, and the removal of effects that are switched off.

#include "../solver/effect_scene.hpp"

#include "frontalis/model/effects.hpp"

#include <gtest/gtest.h>

namespace frontalis
{
namespace
{

using namespace test;

std::string refusal(Model model, EffectSet off)
{
  try
  {
    switch_off(model, off);
  }
  catch (const Error& error)
  {
    return error.what();
  }
  return {};
}

EffectSet only(Effect effect) { return EffectSet().with(effect); }

TEST(ModelEffects, are_those_that_something_has_cause_for)
{
  EXPECT_EQ(names_of(effects_of(scene_of(0))), "elasticity, rigid_nodes");
  const Model whole = scene_of(everything);
  EXPECT_EQ(effects_of(whole), EffectSet::all()
                                   .with(Effect::output_fields, false)
                                   .with(Effect::contact, false)
                                   .with(Effect::self_contact, false)
                                   .with(Effect::attachment, false)
                                   .with(Effect::shell, false)
                                   .with(Effect::cut_voxels, false));
  EXPECT_EQ(presence_of(whole, Effect::contraction).voxels, whole.voxels.size());
  EXPECT_EQ(presence_of(whole, Effect::friction).nodes, whole.sliding.size());
  EXPECT_LT(presence_of(whole, Effect::viscosity).voxels, whole.voxels.size() / 2);
  EXPECT_GT(presence_of(whole, Effect::viscosity).voxels, 0U);
  EXPECT_EQ(presence_of(scene_of(0), Effect::viscosity).why, "no material is viscous");
}

TEST(ModelEffects, a_material_that_no_voxel_has_brings_nothing)
{
  Model model = scene_of(0);
  model.materials.push_back(model.materials[0]);
  model.materials.back().viscous_share[0] = 0.5;
  model.materials.back().viscous_time[0] = 1;
  EXPECT_FALSE(effects_of(model).has(Effect::viscosity));
}

TEST(ModelEffects, one_switched_off_leaves_nothing_and_is_named)
{
  for (const Effect effect : every_effect())
  {
    Model model = scene_of(but_friction);
    if (traits_of(effect).not_off[0] != '\0')
      continue;
    const EffectSet before = effects_of(model);
    switch_off(model, only(effect));
    check_model(model);
    EXPECT_EQ(effects_of(model), before.with(effect, false)) << name_of(effect);
    EXPECT_EQ(model.switched_off, std::vector<std::string>{ name_of(effect) });
    EXPECT_EQ(presence_of(model, effect).why, "switched off by the scene");
  }
}

TEST(ModelEffects, fibres_stay_for_the_other_of_their_effects)
{
  Model passive = scene_of(contraction | passive_fibres);
  switch_off(passive, only(Effect::contraction));
  EXPECT_FALSE(passive.fibre_muscle.empty());
  Model active = scene_of(contraction);
  switch_off(active, only(Effect::contraction));
  EXPECT_TRUE(active.fibre_muscle.empty());
  EXPECT_EQ(active.muscles.size(), 1U);
  Model neither = scene_of(contraction | passive_fibres);
  switch_off(neither, only(Effect::contraction).with(Effect::fibre_stiffness));
  EXPECT_TRUE(neither.fibre_muscle.empty());
}

TEST(ModelEffects, what_others_need_stays_and_unknown_names_are_told_what_there_is)
{
  EXPECT_EQ(refusal(scene_of(0), only(Effect::elasticity)),
            "elasticity cannot be switched off: nothing else holds a voxel together");
  EXPECT_EQ(refusal(scene_of(sliding | friction), only(Effect::sliding)),
            "friction needs sliding: switch friction off too, or sliding on");
  EXPECT_EQ(refusal(scene_of(sliding | friction), only(Effect::sliding).with(Effect::friction)), "");
  try
  {
    effect_from_name("magic");
    FAIL();
  }
  catch (const Error& error)
  {
    EXPECT_STREQ(error.what(),
                 "there is no effect 'magic'; the effects are elasticity, fibre_stiffness, contraction, viscosity, "
                 "gravity, surface_loads, prescribed_displacement, rigid_nodes, sliding, friction, contact, "
                 "self_contact, attachment, shell, cut_voxels, output_fields");
  }
}

}  // namespace
}  // namespace frontalis
